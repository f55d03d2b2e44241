"use strict";
(() => {
  const all = (selector) => [...document.querySelectorAll(selector)];
  const one = (selector) => document.querySelector(selector);
  const rows = all("[data-row]");
  const frames = all("[data-frame]");
  const pictures = all("[data-picture]");
  const slider = one("#step");
  const last = frames.length - 1;
  const first = Number(document.body.dataset.first);
  const loop = Number(document.body.dataset.loop ?? -1) - first;
  const still = window.matchMedia("(prefers-reduced-motion: reduce)");
  let at = -1;
  let timer = null;

  function go(step) {
    const next = Math.max(0, Math.min(last, step));
    if (next === at) return;
    const begun = at >= 0;
    at = next;
    const frame = frames[at];
    frames.forEach((each) => { each.hidden = each !== frame; });
    const shown = [frame.dataset.l, frame.dataset.p];
    pictures.forEach((each) => each.toggleAttribute("hidden", !shown.includes(each.dataset.picture)));
    rows.forEach((row, number) => {
      if (number === at) row.setAttribute("aria-current", "step");
      else row.removeAttribute("aria-current");
    });
    slider.value = String(at);
    slider.setAttribute("aria-valuetext", `c${first + at}: ${frame.dataset.label}`);
    one("#number").textContent = `c${first + at} of c${first + last}`;
    one("#caption").textContent = frame.dataset.label;
    one("#missing").hidden = frame.dataset.l !== "";
    one(".models").hidden = frame.dataset.l === "";
    one("#names").hidden = true;
    if (begun) history.replaceState(null, "", `#c${first + at}`);
    reveal(rows[at], begun);
  }

  function reveal(row, smooth) {
    const [pane, here] = [one(".run").getBoundingClientRect(), row.getBoundingClientRect()];
    const head = one("thead").offsetHeight + 8;
    const [above, below] = [here.top - pane.top - head, here.bottom - pane.bottom + 8];
    const top = above < 0 ? above : Math.max(0, below);
    one(".run").scrollBy({ top, behavior: smooth && !still.matches ? "smooth" : "auto" });
  }

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
      if (at < last) go(at + 1);
      else if (loop >= 0 && loop < last) go(loop);
      else stop();
    }, 1100);
  }

  function named() {
    const found = /^#c(\d{1,9})$/.exec(location.hash);
    return found ? Number(found[1]) - first : null;
  }

  const texts = rows.map((row) => row.textContent.toLowerCase());
  function find(direction) {
    const wanted = one("#find").value.trim().toLowerCase();
    const matches = [...texts.keys()].filter((number) => wanted && texts[number].includes(wanted));
    rows.forEach((row, number) => row.classList.toggle("match", matches.includes(number)));
    const ahead = direction < 0
      ? matches.findLast((number) => number < at) ?? matches.at(-1)
      : matches.find((number) => number > at) ?? matches[0];
    if (direction && ahead !== undefined) { stop(); go(ahead); }
    const rank = matches.indexOf(at) + 1;
    one("#found").textContent = !wanted ? "" : rank ? `${rank} of ${matches.length}` : `${matches.length} found`;
  }

  const keys = {
    ArrowRight: () => go(at + 1), ArrowDown: () => go(at + 1), ArrowLeft: () => go(at - 1), ArrowUp: () => go(at - 1),
    Home: () => go(0), End: () => go(last), " ": play, "/": () => one("#find").focus(),
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
  rows.forEach((row, number) => row.addEventListener("click", (event) => {
    event.preventDefault();
    stop();
    go(number);
  }));
  const acts = { "#first": () => go(0), "#back": () => go(at - 1), "#next": () => go(at + 1), "#last": () => go(last) };
  for (const [button, act] of Object.entries(acts)) one(button).addEventListener("click", () => { stop(); act(); });
  one("#play").addEventListener("click", play);
  window.addEventListener("hashchange", () => { const step = named(); if (step !== null) go(step); });
  all("[data-scripted]").forEach((each) => { each.hidden = false; });
  go(named() ?? Number(document.body.dataset.start));
})();
