/** Texts with a halo, cached as pictures, since outlined letters are slow to draw. */

const FAMILY = 'system-ui, -apple-system, "Segoe UI", "Noto Sans", sans-serif';
const MOST = 3000;
const PAD = 3;

export const FONTS = {
  vehicle: `600 13px ${FAMILY}`,
  named: `500 12px ${FAMILY}`,
  place: `italic 500 12px ${FAMILY}`,
  small: `11px ${FAMILY}`,
  grid: `11px ${FAMILY}`,
};

export class Lettering {
  #pictures = new Map();
  #measures = new Map();
  #ruler = document.createElement("canvas").getContext("2d");

  constructor(halo, ratio) {
    this.halo = halo;
    this.ratio = ratio;
  }

  /** The size of a text: [width, height] in pixels. */
  size(text, font) {
    const key = `${font}\n${text}`;
    let found = this.#measures.get(key);
    if (!found) {
      this.#ruler.font = FONTS[font];
      const { width } = this.#ruler.measureText(text);
      remember(this.#measures, key, (found = [Math.ceil(width), 15]));
    }
    return found;
  }

  /** Draw a text with its upper left corner at a point. */
  draw(ctx, text, [x, y], font, colour) {
    const picture = this.#picture(text, font, colour);
    const [left, top] = [x - PAD, y - PAD].map((value) => Math.round(value * this.ratio) / this.ratio);
    ctx.drawImage(picture, left, top, picture.width / this.ratio, picture.height / this.ratio);
  }

  #picture(text, font, colour) {
    const key = `${colour}\n${font}\n${text}`;
    let found = this.#pictures.get(key);
    if (!found) remember(this.#pictures, key, (found = this.#paint(text, font, colour)));
    return found;
  }

  #paint(text, font, colour) {
    const [width, height] = this.size(text, font);
    const canvas = document.createElement("canvas");
    canvas.width = Math.ceil((width + 2 * PAD) * this.ratio);
    canvas.height = Math.ceil((height + 2 * PAD) * this.ratio);
    const ctx = canvas.getContext("2d");
    ctx.scale(this.ratio, this.ratio);
    Object.assign(ctx, { font: FONTS[font], textBaseline: "middle", lineJoin: "round", lineWidth: 3 });
    ctx.strokeStyle = this.halo;
    ctx.fillStyle = colour;
    const at = [PAD, PAD + height / 2 + 0.5];
    ctx.strokeText(text, ...at);
    ctx.fillText(text, ...at);
    return canvas;
  }
}

function remember(table, key, value) {
  if (table.size >= MOST) table.clear();
  table.set(key, value);
}
