/** The operator's input on the map, by pointer and keys. */

export const TOLERANCE = { mouse: 8, touch: 24 };

/**
 * Pass clicks and pointer positions to the chart. A lifted finger points at nothing, although the browser generates mouse
 * events after a tap.
 */
export function listenForPointer(map, chart) {
  let kind = "mouse";
  const note = ({ pointerType }) => {
    if (pointerType === "touch" && kind !== "touch") chart.point(null, null);
    kind = pointerType;
  };
  for (const each of ["pointerdown", "pointermove"]) map.getContainer().addEventListener(each, note, true);
  map.on("click", ({ containerPoint: { x, y }, latlng }) => {
    const isTouch = kind === "touch";
    if (!isTouch) chart.point([x, y], [latlng.lat, latlng.lng]); // a busy browser reports a click before the motion that leads to it
    chart.click([x, y], [latlng.lat, latlng.lng], isTouch ? TOLERANCE.touch : TOLERANCE.mouse);
  });
  map.on("mousemove", ({ containerPoint: { x, y }, latlng }) => kind !== "touch" && chart.point([x, y], [latlng.lat, latlng.lng]));
  map.on("mouseout", () => chart.point(null, null));
  map.on("dragstart", () => chart.drag());
}

/** The keys of the map while it has the focus; Leaflet has the arrows, + and -. */
export function listenForKeys(element, chart) {
  element.addEventListener("keydown", (event) => {
    if (event.target !== element || event.altKey) return;
    if (keyDeed(event, chart)) event.preventDefault();
  });
}

/** Carry out the action of a key; return whether it has one. */
function keyDeed(event, chart) {
  const withControl = event.ctrlKey || event.metaKey;
  if (withControl) return event.key.toLowerCase() === "c" && !String(getSelection()) && Boolean(chart.copyPosition());
  if (event.key === "Enter") return chart.clickMiddle();
  if (event.key === "Backspace") return chart.undo();
  return event.key === "Escape" && chart.escape();
}
