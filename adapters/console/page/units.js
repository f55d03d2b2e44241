/** Numbers for people, each with its unit: nautical or metric, by this user's choice. */
import { wrapped } from "./map/geodesy.js";
import { kept } from "./ui.js";

export const SYSTEMS = { nautical: "knots, nautical miles, degrees and minutes", metric: "metres a second, kilometres, decimal degrees" };
export const system = kept("units", "nautical");
export const MILE = 1852;

const isMetric = () => system.value === "metric";

// --- time ------------------------------------------------------------------------------------------------------

/** A duration in seconds: "12 s", "3 min 05 s", "2 h 10 min". */
export function duration(seconds) {
  const whole = Math.floor(Math.abs(seconds));
  if (whole < 60) return `${whole} s`;
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${String(whole % 60).padStart(2, "0")} s`;
  if (whole < 172800) return `${Math.floor(whole / 3600)} h ${String(Math.floor(whole / 60) % 60).padStart(2, "0")} min`;
  return `${Math.floor(whole / 86400)} d`;
}

/** The age of a time at `now`; 0 for a time of a clock ahead of ours. */
export const age = (time, now) => duration(Math.max(0, now - time));

/** The time of day in UTC. */
export const utc = (time) => new Date(time * 1000).toISOString().slice(11, 19);

export const day = (time) => new Date(time * 1000).toISOString().slice(0, 10);

/** The time since the beginning: "+00:03:12". */
export function since(seconds) {
  const whole = Math.max(0, Math.floor(seconds));
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60];
  return `+${[hours, minutes, whole % 60].map((part) => String(part).padStart(2, "0")).join(":")}`;
}

const CLOCK = /^(\d{1,2}):(\d\d)(?::(\d\d))?$/;

/** The newest moment from `begin` to `head` at a time of day, "HH:MM" or "HH:MM:SS" in UTC; null for none or an invalid text. */
export function momentOf(text, begin, head) {
  const [, hours, minutes, seconds = "0"] = CLOCK.exec(text.trim()) ?? [];
  if (hours === undefined || Number(hours) > 23 || Number(minutes) > 59 || Number(seconds) > 59) return null;
  const ofDay = Number(hours) * 3600 + Number(minutes) * 60 + Number(seconds);
  const newest = Math.floor((head - ofDay) / 86400) * 86400 + ofDay;
  return newest >= Math.floor(begin) ? Math.max(begin, newest) : null;
}

// --- space -----------------------------------------------------------------------------------------------------

/** An angle in degrees and minutes: `degreesAndMinutes(-8.72, "NS", 2, 3)` is 08°43.200′S. */
function degreesAndMinutes(value, letters, width, digits) {
  const minutes = Math.round(Math.abs(value) * 60 * 10 ** digits) / 10 ** digits;
  const degrees = String(Math.floor(minutes / 60)).padStart(width, "0");
  const rest = (minutes % 60).toFixed(digits).padStart(digits ? digits + 3 : 2, "0");
  return `${degrees}°${rest}′${letters[value < 0 ? 1 : 0]}`;
}

const decimal = (value, letters, digits) => `${Math.abs(value).toFixed(digits + 2)}°${letters[value < 0 ? 1 : 0]}`;

export const latitude = (value, digits = 3) => (isMetric() ? decimal(value, "NS", digits) : degreesAndMinutes(value, "NS", 2, digits));
export const longitude = (value, digits = 3) => (isMetric() ? decimal(wrapped(value), "EW", digits) : degreesAndMinutes(wrapped(value), "EW", 3, digits));
export const position = ([north, east]) => `${latitude(north)} ${longitude(east)}`;

/** A distance in nautical miles, below a cable and a half in metres; or in kilometres, below one in metres. */
export function range(metres) {
  if (metres < (isMetric() ? 1000 : 278)) return `${Math.round(metres)} m`;
  const [value, unit] = isMetric() ? [metres / 1000, "km"] : [metres / MILE, "nm"];
  return `${value.toFixed(value < 10 ? 2 : value < 100 ? 1 : 0)} ${unit}`;
}

export const angle = (value) => `${String(Math.round(value) % 360).padStart(3, "0")}°`;
export const speed = (value) => (isMetric() ? `${value.toFixed(1)} m/s` : `${(value * 1.943844).toFixed(1)} kn`);
export const metres = (value) => `${Math.round(value)} m`;
