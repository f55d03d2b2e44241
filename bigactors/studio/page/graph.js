/**
 * The graph of a mission's configurations in layers: all of a small mission, else those around the run. A step of the run
 * is bold, a bad configuration is red, and a chain of configurations without another way is one edge.
 */
import { html, useEffect, useState } from "/parts/ui.js";
import { counted } from "/parts/map/words.js";

const ACROSS = 46;
const DOWN = 58;
const MARGIN = 24;
const SWEEPS = 6;

/** `ask` and `run` as of the explorer; `onGo(run)` is called with the address of a chosen configuration. */
export function Graph({ ask, run, at, onGo }) {
  const [graph, setGraph] = useState(null);
  const [problem, setProblem] = useState("");
  useEffect(() => {
    let wanted = true;
    ask({ ask: "graph", run }).then(
      (answer) => wanted && (answer.error ? setProblem(answer.error) : (setProblem(""), setGraph(answer))),
      (error) => wanted && setProblem(error.message),
    );
    return () => (wanted = false);
  }, [run]);
  return html`<section class="graph" aria-label="Graph">
    ${problem && html`<p class="problem" role="alert">${problem}</p>`}
    ${graph && html`<output>${graph.whole ? counted(graph.count, "configuration") : `${counted(graph.count, "configuration")} around the run`}${graph.nodes.length < graph.count ? `, ${graph.nodes.length} drawn: chains are folded` : ""}${graph.timed ? ", each step as early as it may be" : ""}</output>
      <${Picture} graph=${graph} at=${at} onGo=${onGo} />`}
  </section>`;
}

function Picture({ graph, at, onGo }) {
  const { places, width, height } = placed(graph);
  const onRun = new Map(graph.nodes.filter((node) => node.at !== undefined).map((node) => [node.id, node.at]));
  return html`<div class="scroll" tabindex="0"><svg width=${width} height=${height} role="group">
    ${graph.edges.map((edge) => html`<path key=${`${edge.from} ${edge.to}`} d=${pathOf(places, edge)} class=${`edge ${onRun.has(edge.from) && onRun.has(edge.to) ? "run" : ""}`} stroke-dasharray=${edge.folded ? "5 3" : null}>
      <title>${wordsOf(edge)}</title></path>`)}
    ${graph.nodes.map((node) => {
      const [x, y] = places.get(node.id);
      const go = () => onGo(node.run);
      const called = `${node.at === undefined ? "" : `c${node.at}, `}${counted(node.depth, "step")} from the start${node.bad ? ", bad" : ""}`;
      return html`<g key=${node.id} class=${`node ${node.bad ? "bad" : ""} ${onRun.has(node.id) ? "run" : ""} ${node.at === at ? "here" : ""}`} role="button" tabindex="0" aria-label=${called} transform=${`translate(${x} ${y})`}
        onClick=${go} onKeyDown=${(event) => event.key === "Enter" && go()}><circle r="9"></circle>${node.at !== undefined && html`<text y="3.5" text-anchor="middle">${node.at}</text>`}<title>${called}</title></g>`;
    })}
  </svg></div>`;
}

/** The steps of an edge in words; alike steps are told once, with their number. */
function wordsOf({ words, folded }) {
  const counts = new Map();
  for (const each of words) counts.set(each, (counts.get(each) ?? 0) + 1);
  const lines = [...counts].slice(0, 12).map(([text, count]) => (count > 1 ? `${text} ×${count}` : text));
  return [...(folded ? [counted(folded + 1, "step")] : []), ...lines, ...(counts.size > 12 ? ["…"] : [])].join("\n");
}

/** The place of each node: layers by distance from the start, each in an order with few crossings. */
export function placed({ nodes, edges }) {
  const depths = [...new Set(nodes.map(({ depth }) => depth))].sort((a, b) => a - b);
  const layers = depths.map((depth) => nodes.filter((node) => node.depth === depth).map(({ id }) => id));
  const near = new Map(nodes.map(({ id }) => [id, []]));
  for (const { from, to } of edges) {
    if (from === to) continue;
    near.get(from).push(to);
    near.get(to).push(from);
  }
  const widest = Math.max(...layers.map((layer) => layer.length));
  const across = new Map();
  const settle = (layer) => layer.forEach((id, n) => across.set(id, n + (widest - layer.length) / 2));
  layers.forEach(settle);
  const middle = (id) => (near.get(id).length ? near.get(id).reduce((sum, other) => sum + across.get(other), 0) / near.get(id).length : across.get(id));
  for (let sweep = 0; sweep < SWEEPS; sweep++) {
    for (const layer of sweep % 2 ? layers.toReversed() : layers) {
      const wishes = new Map(layer.map((id) => [id, middle(id)]));
      layer.sort((a, b) => wishes.get(a) - wishes.get(b));
      settle(layer);
    }
  }
  const places = new Map(layers.flatMap((layer, rank) => layer.map((id) => [id, [MARGIN + across.get(id) * ACROSS, MARGIN + rank * DOWN]])));
  return { places, width: 2 * MARGIN + (widest - 1) * ACROSS + 40, height: 2 * MARGIN + (layers.length - 1) * DOWN };
}

/** A curve between two nodes; a step back or within a layer bends aside, and one to the same node is a loop. */
function pathOf(places, { from, to }) {
  const [[x1, y1], [x2, y2]] = [places.get(from), places.get(to)];
  if (from === to) return `M${x1 + 7} ${y1 - 5}c18 -10 18 20 0 10`;
  if (y2 > y1) return `M${x1} ${y1 + 9}C${x1} ${y1 + 30} ${x2} ${y2 - 30} ${x2} ${y2 - 9}`;
  const aside = Math.max(x1, x2) + 24 + Math.abs(y1 - y2) / 12;
  return `M${x1 + 9} ${y1}C${aside} ${y1} ${aside} ${y2} ${x2 + 9} ${y2}`;
}
