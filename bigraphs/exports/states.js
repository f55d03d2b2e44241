"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const one = (id) => document.getElementById(id);
  const made = (tag, style, text) => {
    const element = document.createElement(tag);
    if (style) element.className = style;
    if (text !== undefined) element.textContent = text;
    return element;
  };
  const drawn = (tag, attributes) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    return element;
  };
  const { places, moves, rules, radius } = data;
  const [leaving, arriving] = [places.map(() => []), places.map(() => [])];
  moves.forEach((move) => { leaving[move[0]].push(move); arriving[move[1]].push(move); });
  const graph = one("graph").querySelector("svg");
  const view = graph.appendChild(drawn("g", {}));

  // --- the transition system

  function arrow([source, target]) {
    const [[x, y], [u, v]] = [places[source], places[target]];
    if (source === target) return `M${x + radius} ${y - 4}c18-14 18 22 1 9`;
    const along = Math.hypot(u - x, v - y);
    const [dx, dy] = [(u - x) / along, (v - y) / along];
    const bend = Math.min(26, along / 6);
    const [mx, my] = [(x + u) / 2 - dy * bend, (y + v) / 2 + dx * bend];
    const back = Math.atan2(v - my, u - mx) + Math.PI;
    const [tx, ty] = [u + radius * Math.cos(back), v + radius * Math.sin(back)];
    const wing = (turn) => `${(tx + 6 * Math.cos(back + turn)).toFixed(1)} ${(ty + 6 * Math.sin(back + turn)).toFixed(1)}`;
    const at = `${tx.toFixed(1)} ${ty.toFixed(1)}`;
    return `M${(x + dx * radius).toFixed(1)} ${(y + dy * radius).toFixed(1)}Q${mx.toFixed(1)} ${my.toFixed(1)} ${at}` +
      `M${wing(-0.4)}L${at}L${wing(0.4)}`;
  }
  const many = moves.length > 400 ? " many" : "";
  const arrows = (list, style) => view.appendChild(drawn("path", { class: `arrows ${style}`, d: list.map(arrow).join("") }));
  arrows(moves, many);
  const [arrived, left] = [arrows([], "in"), arrows([], "out")];
  const states = places.map(([x, y], state) => {
    const style = ["state", data.labels[state].length && "holds", state < data.expanded && !leaving[state].length && "end",
      state === 0 && "first", state >= data.expanded && "open"];
    const group = drawn("g", { class: style.filter(Boolean).join(" "), "data-state": state });
    group.append(drawn("title", {}), drawn("circle", { cx: x, cy: y, r: radius }), drawn("text", { x, y: y + 3.5 }));
    group.children[0].textContent = [`state ${state}`, ...data.labels[state]].join(", ");
    group.children[2].textContent = state;
    return view.appendChild(group);
  });

  // --- the view: its scale and the position of the origin

  let [scale, left0, top0] = [1, 0, 0];
  const size = () => [graph.clientWidth || 600, graph.clientHeight || 400];
  function place() { view.setAttribute("transform", `translate(${left0} ${top0}) scale(${scale})`); }
  function zoom(factor, x = size()[0] / 2, y = size()[1] / 2) {
    const next = Math.max(0.02, Math.min(6, scale * factor));
    [left0, top0] = [x - (x - left0) * next / scale, y - (y - top0) * next / scale];
    scale = next;
    place();
  }
  const [farX, farY] = [0, 1].map((axis) => places.reduce((most, spot) => Math.max(most, spot[axis]), 0) + 2 * radius);
  const fitting = () => Math.min(1.5, size()[0] / farX, (size()[1] - 44) / farY);
  function whole() {
    scale = fitting();
    [left0, top0] = [(size()[0] - farX * scale) / 2, 44];
    place();
  }
  function centre(state, across = 0.5, down = 0.5) {
    [left0, top0] = [size()[0] * across - places[state][0] * scale, size()[1] * down - places[state][1] * scale];
    place();
  }
  function begin() {
    whole();
    if (scale < 0.5) { scale = 0.8; centre(0, 0.5, 0.2); }
  }
  function reveal(state) {
    const [x, y] = [left0 + places[state][0] * scale, top0 + places[state][1] * scale];
    if (x < 20 || y < 50 || x > size()[0] - 20 || y > size()[1] - 20) centre(state);
  }
  const fingers = new Map();
  let dragged = false;
  graph.addEventListener("pointerdown", (event) => { fingers.set(event.pointerId, event); if (fingers.size === 1) dragged = false; });
  window.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY];
    if (!dragged && Math.hypot(dx, dy) < 4) return;
    dragged = true;
    const other = [...fingers.values()].find((each) => each.pointerId !== event.pointerId);
    fingers.set(event.pointerId, event);
    if (!other) { left0 += dx; top0 += dy; place(); return; }
    const apart = (finger) => Math.hypot(finger.clientX - other.clientX, finger.clientY - other.clientY) || 1;
    const box = graph.getBoundingClientRect();
    zoom(apart(event) / apart(before), (event.clientX + other.clientX) / 2 - box.left, (event.clientY + other.clientY) / 2 - box.top);
  });
  for (const end of ["pointerup", "pointercancel"]) window.addEventListener(end, (event) => fingers.delete(event.pointerId));
  graph.addEventListener("wheel", (event) => {
    event.preventDefault();
    const box = graph.getBoundingClientRect();
    zoom(Math.exp(-event.deltaY / 500), event.clientX - box.left, event.clientY - box.top);
  }, { passive: false });
  graph.addEventListener("click", (event) => {
    const state = event.target.closest("[data-state]");
    if (state && !dragged) show(Number(state.dataset.state));
  });
  const shift = (x, y) => { left0 += x; top0 += y; place(); };
  const keys = { "+": () => zoom(1.3), "-": () => zoom(1 / 1.3), "0": whole, ArrowLeft: () => shift(60, 0),
    ArrowRight: () => shift(-60, 0), ArrowUp: () => shift(0, 60), ArrowDown: () => shift(0, -60) };
  graph.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || !(event.key in keys)) return;
    event.preventDefault();
    keys[event.key]();
  });
  one("in").onclick = keys["+"];
  one("out").onclick = keys["-"];
  one("whole").onclick = whole;
  one("start").onclick = () => { show(0); centre(0, 0.5, 0.2); };
  one("find").addEventListener("change", (event) => {
    const state = Number(event.target.value);
    if (event.target.value !== "" && state in places) { show(state); centre(state); }
  });

  // --- one state

  const button = (text, state) => {
    const [item, link] = [made("li"), made("button", "", text)];
    link.type = "button";
    link.onclick = () => { show(state); reveal(state); };
    item.append(link);
    return item;
  };
  let chosen = 0;
  const rule = (from, to) => rules[(leaving[from].find((move) => move[1] === to) || [0, 0, 0])[2]];
  function show(state) {
    one("name").textContent = `state ${state}`;
    one("labels").replaceChildren(...data.labels[state].map((label) => made("span", "label", label)));
    one("moves").replaceChildren(...leaving[state].map((move) => button(`${rules[move[2]]} → ${move[1]}`, move[1])));
    if (state >= data.expanded) one("moves").append(made("li", "", "not explored"));
    else if (!leaving[state].length) one("moves").append(made("li", "", "nothing"));
    const path = [];
    for (let at = state; at !== 0; at = data.paths[at]) path.unshift(button(`${rule(data.paths[at], at)} → ${at}`, at));
    one("path").replaceChildren(button("state 0", 0), ...path);
    states.forEach((each, number) => each.classList.toggle("on", number === state));
    left.setAttribute("d", leaving[state].map(arrow).join(""));
    arrived.setAttribute("d", arriving[state].map(arrow).join(""));
    chosen = state;
    draw(data.states[state].map((number) => data.nodes[number]));
  }

  // --- its bigraph: the browser lays out the boxes, curves join the ports

  function draw(nodes) {
    const picture = one("picture");
    const names = made("div", "names");
    const regions = Array.from({ length: data.regions }, () => made("div", "region inside"));
    const boxes = nodes.map(([control, name], number) => {
      const box = made("div", "node");
      const [fill, border, ink] = data.kinds[control];
      Object.assign(box.style, { background: fill, borderColor: border, color: ink });
      const count = nodes.filter((each) => each[0] === control && !each[1]).length;
      const rank = nodes.slice(0, number + 1).filter((each) => each[0] === control && !each[1]).length;
      box.append(made("span", "", name || (count > 1 ? `${control}#${rank}` : control)), made("div", "inside"));
      return box;
    });
    const place = (parent) => parent < 0 ? regions[-parent - 1] : boxes[parent].lastChild;
    nodes.forEach(([, , parents], number) => parents.forEach((parent, rank) => {
      const box = rank === 0 ? boxes[number] : boxes[number].cloneNode(true);
      if (rank > 0) { box.classList.add("ghost"); box.lastChild.remove(); }
      place(parent).append(box);
    }));
    const links = new Map();
    nodes.forEach(([, , , ports], number) => ports.forEach((link) => links.set(link, [...(links.get(link) || []), number])));
    const sorted = [...links.keys()].sort();
    const colour = (link) => data.colours[sorted.indexOf(link) % data.colours.length];
    const pills = new Map();
    for (const link of sorted.filter((each) => !each.startsWith("/"))) {
      const pill = made("span", "name", link);
      pill.style.borderColor = pill.style.color = colour(link);
      pills.set(link, pill);
      names.append(pill);
    }
    const curves = drawn("svg", { "aria-hidden": "true" });
    picture.replaceChildren(...(pills.size ? [names] : []), ...regions, curves);
    const origin = picture.getBoundingClientRect();
    const spot = (element, down) => {
      const box = element.getBoundingClientRect();
      return [box.left + box.width / 2 - origin.left + picture.scrollLeft, (down ? box.bottom : box.top) - origin.top];
    };
    for (const link of sorted) {
      const ends = links.get(link).map((number) => spot(boxes[number], false));
      const middle = [0, 1].map((axis) => ends.reduce((sum, end) => sum + end[axis], 0) / ends.length);
      const goal = pills.has(link) ? spot(pills.get(link), true) : [middle[0], Math.min(...ends.map((end) => end[1])) - 14];
      for (const [x, y] of ends) {
        const d = `M${x} ${y}C${x} ${y - 14} ${goal[0]} ${goal[1] + 18} ${goal[0]} ${goal[1]}`;
        curves.append(drawn("path", { d, stroke: colour(link) }), drawn("circle", { cx: x, cy: y, r: 3, fill: colour(link) }));
      }
    }
  }

  if (!data.states.length) return;
  begin();
  show(0);
  window.addEventListener("resize", () => show(chosen));
})();
