/** The chart's form of names and counts. */
const LONGEST = 28;

/** A text on one line, without characters that change the writing direction. */
export const plain = (text) => String(text).replace(/[\p{Cc}\p{Cf}\p{Zl}\p{Zp}]/gu, "\u00b7");

/** A name for drawing: plain, and not too long. */
export function drawable(name) {
  const letters = [...plain(name)];
  return letters.length > LONGEST ? `${letters.slice(0, LONGEST - 1).join("")}…` : letters.join("");
}

/** "1 vehicle", "2 vehicles". */
export const counted = (count, noun) => `${count.toLocaleString("en")} ${noun}${count === 1 ? "" : "s"}`;
