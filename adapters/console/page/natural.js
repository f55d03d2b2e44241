/** The natural order of names, in which numbers count as such: uav2 before uav10. */
const NATURAL = new Intl.Collator("en", { numeric: true });
export const byName = (a, b) => NATURAL.compare(a, b);
