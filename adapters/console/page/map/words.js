/** Names and counts as the chart writes them. */
const LONGEST = 28;

/** A text on one line, without what turns the direction of writing. */
export const plain = (text) => String(text).replace(/[\p{Cc}\p{Cf}\p{Zl}\p{Zp}]/gu, "\u00b7");

/** A name as it may be drawn: plain, and not too long. */
export function drawable(name) {
  const letters = [...plain(name)];
  return letters.length > LONGEST ? `${letters.slice(0, LONGEST - 1).join("")}…` : letters.join("");
}

/** "1 vehicle", "2 vehicles". */
export const counted = (count, noun) => `${count.toLocaleString("en")} ${noun}${count === 1 ? "" : "s"}`;
