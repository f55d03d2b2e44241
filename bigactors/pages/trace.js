"use strict";
(() => {
  const all = (selector) => [...document.querySelectorAll(selector)];
  const one = (selector) => document.querySelector(selector);
  const numbers = (words) => words.split(" ").map((word) => (word === "" ? null : Number(word)));
  const { order: places, tenths } = one("main").dataset;
  const order = numbers(places);
  const times = [];
  if (tenths) numbers(tenths).reduce((sum, gap) => { times.push(sum + gap); return sum + gap; }, 0);
  const frames = all("[data-frame]");
  const pictures = all("[data-picture]");
  const words = all("[data-words]");
  const folds = all("[data-from]");
  const body = one("tbody");
  const shown = new Map(all("[data-row]").map((row) => [Number(row.dataset.row), row]));
  const rows = [...shown.values(), ...one("#others").content.children];
  const models = new Map(rows.map((row) => [Number(row.dataset.frameRow), row]));
  const lanes = all("thead th").length - 1;
  const slider = one("#step");
  const last = order.length - 1;
  const loop = Number(document.body.dataset.loop ?? -1);
  const still = window.matchMedia("(prefers-reduced-motion: reduce)");
  const MOST = 200;
  let at = -1;
  let timer = null;

  const clock = (step) => (times.length ? ` \u00b7 ${(times[step] / 10).toFixed(1)} s` : "");
  const label = (step) => (order[step] === null ? "left out of this page" : frames[order[step]].dataset.label);
  const folding = new Array(order.length);
  folds.forEach((row) => folding.fill(row, Number(row.dataset.from), Number(row.dataset.to) + 1));

  function go(step) {
    const next = Math.max(0, Math.min(last, step));
    if (next === at) return;
    const begun = at >= 0;
    at = next;
    const frame = frames[order[at] ?? -1];
    const { l, p, inWords } = frame?.dataset ?? { l: "", p: "" };
    frames.forEach((each) => { each.hidden = each !== frame; });
    pictures.forEach((each) => each.toggleAttribute("hidden", ![l, p].includes(each.dataset.picture)));
    words.forEach((each) => { each.hidden = each.dataset.words !== inWords; });
    const missing = frame
      ? "This configuration is not drawn: this page has the pictures of others."
      : "This configuration is not on this page.";
    one("#missing").textContent = `${missing} bigactors show --step ${at}, with the same --trace, has it.`;
    one("#missing").hidden = l !== "" && p !== "";
    one("#words").hidden = frame === undefined;
    one(".models").hidden = l === "" && p === "";
    slider.value = String(at);
    slider.setAttribute("aria-valuetext", `c${at}${clock(at)}: ${label(at)}`);
    one("#number").textContent = `c${at} of c${last}${clock(at)}`;
    one("#caption").textContent = label(at);
    one("#names").hidden = true;
    if (begun) history.replaceState(null, "", `#c${at}`);
    mark(begun);
  }

  function mark(smooth) {
    all(".now").forEach((each) => { each.textContent = ""; });
    all("[aria-current]").forEach((each) => each.removeAttribute("aria-current"));
    const row = shown.get(at) ?? folding[at];
    if (!shown.has(at)) row.querySelector(".now").textContent = `c${at}${clock(at)}: ${label(at)}`;
    row.setAttribute("aria-current", "step");
    reveal(row, smooth);
  }

  function reveal(row, smooth) {
    const [pane, here] = [one(".run").getBoundingClientRect(), row.getBoundingClientRect()];
    const head = one("thead").offsetHeight + 8;
    const [above, below] = [here.top - pane.top - head, here.bottom - pane.bottom + 8];
    const top = above < 0 ? above : Math.max(0, below);
    one(".run").scrollBy({ top, behavior: smooth && !still.matches ? "smooth" : "auto" });
  }

  function make(tag, properties = {}, ...inside) {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...inside);
    return made;
  }

  function stepRow(step) {
    const model = models.get(order[step] ?? -1);
    const row = model ? model.cloneNode(true) : make("tr", {}, make("th"), make("td", { colSpan: lanes, textContent: label(step) }));
    const link = make("a", { href: `#c${step}`, textContent: `c${step}` });
    row.querySelector("th").replaceChildren(link, make("small", { textContent: clock(step).slice(3) }));
    row.removeAttribute("aria-current");
    row.classList.add("unfolded");
    row.dataset.row = step;
    return row;
  }

  function moreRow(from, to) {
    const button = make("button", { type: "button", textContent: `c${from} to c${to}` });
    const row = make("tr", { className: "unfolded more" }, make("th"), make("td", { colSpan: lanes }, button));
    row.dataset.more = from > at ? from : to;
    return row;
  }

  function close(row) {
    row.querySelector("button").textContent = "unfold";
    row.querySelector("button").setAttribute("aria-expanded", "false");
    while (row.nextElementSibling?.classList.contains("unfolded")) {
      shown.delete(Number(row.nextElementSibling.dataset.row));
      row.nextElementSibling.remove();
    }
  }

  function open(row, around) {
    close(row);
    row.querySelector("button").textContent = "fold";
    row.querySelector("button").setAttribute("aria-expanded", "true");
    const [from, to] = [Number(row.dataset.from), Number(row.dataset.to)];
    const begin = Math.max(from, Math.min(around - MOST / 2, to - MOST + 1));
    const end = Math.min(to, begin + MOST - 1);
    const added = [];
    if (begin > from) added.push(moreRow(from, begin - 1));
    for (let step = begin; step <= end; step += 1) {
      added.push(stepRow(step));
      shown.set(step, added.at(-1));
    }
    if (end < to) added.push(moreRow(end + 1, to));
    row.after(...added);
  }

  function toggle(row) {
    const opened = row.querySelector("button").getAttribute("aria-expanded") === "true";
    if (opened) close(row);
    else open(row, folding[at] === row ? at : Number(row.dataset.from));
    mark(false);
    find(0);
  }

  const onRow = () => (shown.has(at) ? at : Number(folding[at].dataset.to)) + 1;
  const backRow = () => (shown.has(at) ? at : Number(folding[at].dataset.from)) - 1;

  function stop() {
    clearInterval(timer);
    timer = null;
    one("#play").textContent = "Play";
    one("#play").setAttribute("aria-pressed", "false");
  }

  function play() {
    if (timer !== null) { stop(); return; }
    if (at === last) go(0);
    one("#play").textContent = "Pause";
    one("#play").setAttribute("aria-pressed", "true");
    timer = setInterval(() => {
      if (at < last) go(onRow());
      else if (loop >= 0 && loop < last) go(loop);
      else stop();
    }, 1100);
  }

  function named() {
    const found = /^#c(\d{1,9})$/.exec(location.hash);
    return found ? Number(found[1]) : null;
  }

  const contents = frames.map((_, place) => models.get(place)?.querySelector(".step")?.textContent.toLowerCase() ?? "");
  function find(direction) {
    const wanted = one("#find").value.trim().toLowerCase();
    const hits = contents.map((content) => wanted !== "" && content.includes(wanted));
    const matches = [...order.keys()].filter((step) => hits[order[step] ?? -1] || wanted === `c${step}`);
    const [found, within] = [new Set(matches), new Set(matches.map((step) => folding[step]))];
    shown.forEach((row, step) => row.classList.toggle("match", found.has(step)));
    folds.forEach((row) => row.classList.toggle("match", within.has(row)));
    const ahead = direction < 0
      ? matches.findLast((number) => number < at) ?? matches.at(-1)
      : matches.find((number) => number > at) ?? matches[0];
    if (direction && ahead !== undefined) { stop(); go(ahead); }
    const rank = matches.indexOf(at) + 1;
    one("#found").textContent = !wanted ? "" : rank ? `${rank} of ${matches.length}` : `${matches.length} found`;
  }

  const keys = {
    ArrowRight: () => go(at + 1), ArrowDown: () => go(at + 1), ArrowLeft: () => go(at - 1), ArrowUp: () => go(at - 1),
    j: () => go(onRow()), k: () => go(backRow()), Home: () => go(0), End: () => go(last), " ": play,
    "/": () => one("#find").focus(),
  };
  document.addEventListener("keydown", (event) => {
    const held = event.ctrlKey || event.metaKey || event.altKey || event.shiftKey;
    const theirs = event.key === " " ? "button, summary, pre, #find" : "pre, #find";
    if (held || !(event.key in keys) || event.target.closest(theirs)) return;
    if (event.key !== " ") stop();
    event.preventDefault();
    keys[event.key]();
  });
  one("#find").addEventListener("input", () => find(0));
  one("#find").addEventListener("keydown", (event) => { if (event.key === "Enter") find(event.shiftKey ? -1 : 1); });
  one(".models").addEventListener("click", (event) => {
    const several = event.target.closest("[data-names]");
    one("#names").hidden = several === null;
    if (several) one("#names").textContent = `${several.querySelector("text").textContent}: ${several.dataset.names}`;
  });
  slider.addEventListener("input", () => { stop(); go(Number(slider.value)); });
  body.addEventListener("click", (event) => {
    event.preventDefault();
    stop();
    const row = event.target.closest("tr");
    if (row.dataset.more) {
      go(Number(row.dataset.more));
      open(folding[at], at);
      mark(false);
      find(0);
    } else if (event.target.closest("button")) toggle(row);
    else go(Number(row.dataset.row ?? row.dataset.from));
  });
  const acts = { "#first": () => go(0), "#back": () => go(at - 1), "#next": () => go(at + 1), "#last": () => go(last) };
  for (const [button, act] of Object.entries(acts)) one(button).addEventListener("click", () => { stop(); act(); });
  one("#play").addEventListener("click", play);
  window.addEventListener("hashchange", () => { const step = named(); if (step !== null) go(step); });
  all("[data-scripted]").forEach((each) => { each.hidden = false; });
  go(named() ?? Number(document.body.dataset.start));
})();
