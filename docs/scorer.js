// Ranks the pages found by the search: pages with the words in the title first, and users' pages before maintainers' pages.
const asked = (new URLSearchParams(location.search).get("q") || "").toLowerCase().split(/\s+/).filter(Boolean);
const shelf = { "docs/tutorial": 3, "docs/how-to": 4, "docs/reference": 2, "docs/explanation": 1 };

var Scorer = {
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
  score: ([page, title, , , score]) => {
    const named = asked.filter((word) => title.toLowerCase().includes(word)).length;
    return score + 10 * named + (shelf[page.split("/").slice(0, 2).join("/")] || 0);
  },
};
