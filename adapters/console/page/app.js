/** The operator's console: one screen with the content of a recording and the actions of the operator. */
import { Find } from "./find.js";
import { dress, first, html, render, memo, kept, owed, useEffect, useLayoutEffect, useRef, useSections, useWatched, Watched } from "./ui.js";
import { Alert } from "./alert.js";
import { Announcer } from "./announce.js";
import { Brief, Cards, worstFirst } from "./cards.js";
import { Clock } from "./clock.js";
import { Door } from "./login.js";
import { Help, listenForKeys } from "./keys.js";
import { Link } from "./link.js";
import { Mission, NotConnected } from "./mission.js";
import { NoticeList, Notices } from "./notices.js";
import { Orders, SideEffects } from "./orders.js";
import { Preflight } from "./preflight.js";
import { Sound } from "./sound.js";
import { Store } from "./store.js";
import { openTab, Panel, PANELS, TabList, usePhone } from "./tabs.js";
import { TargetFilter, Targets } from "./targets.js";
import { neighbour, SPEEDS, Timeline } from "./timeline.js";
import { Ways } from "./ways.js";
import { Who } from "./operator_name.js";

/** Milliseconds within which a connection under a new name must open; after them the action is not sent. */
const CONNECTS = 10_000;

const PAST = "The past is shown: to act, go to the newest moment (L).";
const NOT_STARTED = "The run has not started: press Start first.";

/** The parameters in the link's fragment; browsers send no fragment, so the token is in no request. */
const fragment = () => new URLSearchParams(location.hash.slice(1));

class App {
  store = new Store();
  clock = new Clock(this.store);
  notices = new Notices(this.store);
  tell = this.notices.tell;
  sound = new Sound(this.store);
  targets = new Targets(this.store);
  chosen = new Watched(null);
  /** The vehicles that are chosen for an order to several. */
  several = new Watched(new Set());
  following = new Watched(false);
  measuring = new Watched(false);
  enlarged = new Watched(false);
  help = new Watched(false);
  /** Whether all alerts are listed. */
  listing = new Watched(false);
  tab = new Watched("map");
  hiddenSorts = new Watched(new Set());
  mayAct = new Watched(false);
  /** Whether it may act, and the run has started: before, the run takes no order, message or note. */
  mayOrder = new Watched(false);
  past = new Watched(false);
  /** Whether this page could act, if it did not show the past. */
  inPast = new Watched(false);
  /** The action that waits for the operator's name: `{action, words}`. */
  pending = new Watched(null);
  /** Whether the page asks for a name before any action, as it does once at the beginning. */
  asking = new Watched(false);
  /** The speed at which the past is played. */
  speed = new Watched(1);
  /** Whether the newest known moment is old, so that nothing is known of any vehicle now. */
  stale = new Watched(false);
  /** The mission's only vehicle; null if it has several or none. */
  only = new Watched(null);
  /** The vehicles in the order of their cards; empty while no cards are shown. */
  order = [];
  whyNot = new Watched("");
  name = kept("name", "");
  look = kept("look", "");
  singleKeys = kept("keys", "on");
  theme = new Watched("light");
  tabs = PANELS;
  map = null;
  seeking = null;

  constructor() {
    this.link = new Link(this.store, { token: fragment().get("token") ?? "", name: this.name.value, nameless: () => this.#nameless() });
    this.link.state.on(({ state }) => (this.clock.connected = state === "open"));
    this.link.state.on(() => this.#judge());
    this.link.error.on((message) => message && this.tell(message));
    this.store.on(["clock", "preflight"], () => this.#judge());
    const off = this.mayAct.on((may) => {
      if (!may) return;
      off();
      this.asking.set(!this.name.value);
    });
    this.name.on((name) => {
      this.link.name = name;
      this.link.connect(); // the hello of each connection has the name
    });
    this.chosen.on((name) => this.map?.choose(name));
    this.store.on(["vehicles"], () => this.only.set(onlyOf(this.store.section("vehicles"))));
    this.store.on(["clock"], () => {
      this.past.set(this.clock.get("live") === false && !this.clock.atEnd);
      const { playing, speed } = this.clock.wanted;
      if (playing) this.speed.set(speed);
    });
    for (const watched of [this.chosen, this.following, this.only]) watched.on(() => this.#follow());
    this.measuring.on((on) => this.map?.measure(on));
    dress(this.look, this.theme);
    this.theme.on((theme) => this.map?.setTheme(theme));
    owed.on(() => queueMicrotask(this.#tellDrawn));
  }

  /** Publish the number of the last fully drawn frame, for programs that drive this page: `<html data-drawn="7">`. */
  #tellDrawn = () => {
    if (owed.value === 0 && this.link.frame > 0) document.documentElement.dataset.drawn = this.link.frame;
  };

  /** The chosen vehicle or entity, else the only vehicle. */
  get subject() {
    return this.chosen.value ?? this.only.value;
  }

  #follow() {
    this.map?.follow(this.following.value ? this.subject : null);
  }

  /** Update whether this page may act now, and if not, the reason. */
  #judge() {
    const { role, mode } = this.link.welcome.value ?? {};
    const heard = this.link.state.value.state === "open" && !this.clock.get("unread");
    this.stale.set(mode === "live" && !heard && (this.clock.get("broken_off") || !this.clock.get("ended")));
    const why =
      mode === "replay" ? "This is a recording that has ended: nothing can be done in it."
      : role !== "act" ? "This link lets you watch. To act, open the link that the program printed for it."
      : this.link.state.value.state !== "open" && (this.clock.get("broken_off") || !this.clock.get("ended")) ? "Not connected: nothing can be done from here now."
      : this.clock.get("ended") ? "The run has ended: nothing can be done any more."
      : this.clock.get("live") === false ? PAST
      : "";
    const started = !["waits", "ready"].includes(this.store.section("preflight").get("state"));
    this.whyNot.set(why || (started ? "" : NOT_STARTED));
    this.mayAct.set(why === "");
    this.mayOrder.set(why === "" && started);
    this.inPast.set(why === PAST);
  }

  /** Ask for an action, and show its outcome; `words` are `{what, about}` as the recording will have them. */
  act = async (action, words) => {
    if (!this.name.value) return this.pending.set({ action, words });
    const notice = this.notices.asked(words, this.name.value);
    this.notices.answered(notice, await this.link.act(action), !action.acknowledge && !action.start);
  };

  /** Take a name, and perform the action that waited for it once a connection under that name is open. */
  async actAs(name) {
    this.asking.set(false);
    if (!this.pending.value) return this.name.set(name);
    const { action, words } = this.pending.value;
    this.pending.set(null);
    if (!this.mayAct.value) return this.tell(`Not sent: ${words.what} ${words.about}. ${this.whyNot.value}`);
    this.name.set(name);
    if (await this.#opened()) this.act(action, words);
    else this.tell(`Not sent: ${words.what} ${words.about}: there is no connection.`);
  }

  forgetPending() {
    if (this.pending.value) this.tell("Nothing was sent.");
    this.pending.set(null);
    this.asking.set(false);
  }

  /** Whether a connection opens within a few seconds. */
  #opened() {
    return new Promise((resolve) => {
      const off = this.link.state.on(({ state }) => state === "open" && settle(true));
      const timer = setTimeout(() => settle(false), CONNECTS);
      const settle = (opened) => {
        off();
        clearTimeout(timer);
        resolve(opened);
      };
      if (this.link.state.value.state === "open") settle(true);
    });
  }

  #nameless() {
    this.tell(`“${this.name.value}” cannot be recorded as a name: give another.`);
    this.name.set("");
  }

  seek = (time) => {
    this.link.send({ type: "seek", time });
    this.clock.ask({ playing: this.clock.wanted.playing });
  };
  live = () => {
    clearTimeout(this.seeking); // an earlier seek is obsolete
    this.link.send({ type: "live" });
    this.clock.ask({ live: true });
  };
  play = (speed) => {
    this.link.send({ type: "play", speed });
    this.clock.ask({ playing: true, speed });
  };
  pause = () => {
    this.link.send({ type: "pause" });
    this.clock.ask({});
  };
  /** Play or pause; at the end of a run that has ended, play from the beginning. */
  playOrPause = () => {
    const { live, playing } = this.clock.wanted;
    if (this.clock.atEnd) this.seek(this.clock.get("begin"));
    if (!this.clock.atEnd && (playing || live)) this.pause();
    else this.play(this.speed.value);
  };
  /** Choose the speed at which the past is played; a paused or live display stays so. */
  setSpeed = (speed) => {
    this.speed.set(speed);
    if (this.clock.wanted.playing) this.play(speed);
  };
  back = (seconds) => this.goTo(this.clock.now - seconds);
  /** Show a moment and stay there. */
  goTo = (time) => {
    const within = Math.max(this.clock.get("begin") ?? time, time);
    if (this.clock.wanted.playing) this.pause();
    this.seek(within);
    this.clock.expect(within); // the next request starts from there
  };
  step = (direction) => {
    const time = neighbour(this.store.section("ticks"), this.clock.now, direction, this.hiddenSorts.value);
    if (time === null) this.tell(direction < 0 ? "There is no tick before." : "There is no later tick.");
    else this.goTo(time);
  };
  faster = (by) => {
    const at = SPEEDS.findIndex((speed) => speed >= this.speed.value);
    this.setSpeed(SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, at + by))]);
  };

  chooseNext = (by) => {
    const names = this.order.length ? this.order : worstFirst(this.store.section("vehicles"));
    if (names.length === 0) return;
    const at = names.indexOf(this.chosen.value);
    this.chosen.set(names[at < 0 ? (by > 0 ? 0 : names.length - 1) : (at + by + names.length) % names.length]);
  };
  /** Choose a thing and bring it into view. */
  find = (name) => {
    if (this.chosen.value === name) this.map?.choose(name);
    else this.chosen.set(name);
    if (!this.store.section("vehicles").has(name) || this.tab.value !== "vehicles") this.showTab("map");
  };
  otherSound = () => this.sound.wanted.set(this.sound.wanted.value === "on" ? "off" : "on");
  focusCard = () => this.#focus("vehicles", ".fleet:has(.card.chosen) .name, .card.chosen .name, .fleet .name, .card .name");
  focusMap = () => this.#focus("map", "#map .leaflet-container");
  focusFind = () => this.#focus("map", "#find");
  /** Focus a part of a tab: at once if it is visible, since the next key is meant for it, else when the tab is drawn. */
  #focus(tab, selector) {
    this.showTab(tab);
    const focus = () => {
      const part = document.querySelector(selector);
      part?.focus();
      return document.activeElement === part;
    };
    const before = document.activeElement;
    if (!focus()) requestAnimationFrame(() => [before, document.body].includes(document.activeElement) && focus()); // unless the user went elsewhere
  }
  showTab = (key) => this.tab.set(key);
  escape = () => {
    const unfolded = [...document.querySelectorAll("details.verdict[open], details.map-legend[open], details.targets[open]")];
    if (this.help.value) this.help.set(false);
    else if (this.listing.value) this.listing.set(false);
    else if (unfolded.length > 0) unfolded.forEach((each) => (each.open = false));
    else if (this.enlarged.value) this.enlarged.set(false);
    else if (this.measuring.value) this.measuring.set(false);
    else this.chosen.set(null);
  };
  otherTheme = () => this.look.set(this.theme.value === "dark" ? "light" : "dark");

  admit(token) {
    this.link.token = token;
    history.replaceState(null, "", `#token=${encodeURIComponent(token)}`);
    this.link.connect();
  }

  /** Save a file: of the console, or the picture of the map. */
  save = async (name) => {
    try {
      const content = name === "map.png" ? await this.map.picture() : await (await this.#fetch(`/export/${name}`)).blob();
      const link = document.createElement("a");
      link.href = URL.createObjectURL(content);
      link.download = `${this.store.section("mission").get("name") ?? "flight"}-${name}`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
    } catch (problem) {
      this.tell(`Not saved: ${problem.message}`);
    }
  };

  /** Get JSON from the program that serves this page, with the token. */
  fetchJson = async (path) => (await this.#fetch(path)).json();

  async #fetch(path) {
    const answer = await fetch(path, { headers: { Authorization: `Bearer ${this.link.token}` } });
    if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
    return answer;
  }

  async openMap(element) {
    const { createMap } = await import("./map/map.js");
    const { tiles } = await first(this.link.welcome);
    this.map = createMap(element, this.store, {
      select: (name) => this.chosen.set(name),
      fetchJson: this.fetchJson,
      tiles: tiles ? { url: "/tiles", headers: { Authorization: `Bearer ${this.link.token}` } } : null,
      followed: () => this.following.set(false),
      measured: (on) => this.measuring.set(on),
      hidden: () => this.targets.hidden,
      covers: () => document.querySelectorAll(".map-tools > *, .subject"),
    });
    this.map.setTheme(this.theme.value);
    this.map.choose(this.chosen.value);
    this.#follow();
  }

  closeMap() {
    this.map?.destroy();
    this.map = null;
  }
}

const onlyOf = (vehicles) => (vehicles.size === 1 ? vehicles.keys().next().value : null);

function Page({ app }) {
  const state = useWatched(app.link.state);
  const refused = useRef(null);
  const known = app.clock.now !== null; // the last view stays: another run may be served here now
  if (known || state.state !== "connecting") refused.current = !known && state.state === "refused" ? state : null;
  return refused.current ? html`<${Door} app=${app} ...${refused.current} />` : html`<${Screen} app=${app} />`;
}

function Screen({ app }) {
  const phone = usePhone();
  const tab = openTab(useWatched(app.tab), phone);
  const large = useWatched(app.enlarged) && !phone;
  const past = useWatched(app.past);
  useLayoutEffect(() => app.map?.redraw(), [phone, tab, large]);
  return html`<div class=${`screen ${phone ? "phone" : "desk"} ${large ? "large" : ""} ${past ? "past" : ""}`} data-tab=${tab}>
    <${Mission} app=${app} />
    <${NotConnected} app=${app} />
    <${Alert} app=${app} />
    <${Preflight} app=${app} key="preflight" />
    ${phone && html`<nav key="tabs" aria-label="Tabs"><${TabList} app=${app} phone=${true} /></nav>`}
    <main key="main">
      <section class="map-area" id="area-map" aria-label="Map" key="map"><${MapElement} app=${app} /><${MapTools} app=${app} />${phone && html`<${Subject} app=${app} />`}</section>
      <aside key="side" id="area-vehicles">
        ${(!phone || tab === "vehicles") && html`<${Cards} app=${app} key="cards" />`}
        ${(!phone || tab === "vehicles") && html`<${Ways} app=${app} key="ways" />`}
        ${!phone && html`<${TabList} key="tabs" app=${app} phone=${false} />`}
        <${Panel} app=${app} phone=${phone} key="panel" />
      </aside>
    </main>
    <${Timeline} app=${app} key="timeline" />
    <${NoticeList} app=${app} key="notices" />
    <${Help} app=${app} key="help" />
    <${Who} app=${app} key="who" />
  </div>`;
}

/** On a phone's map: the state of the chosen or only vehicle, and the buttons for its orders. */
function Subject({ app }) {
  useWatched(app.chosen);
  useWatched(app.only);
  const [vehicles] = useSections(app.store, ["vehicles", "entities"], 200);
  const card = vehicles.get(app.subject);
  if (!card) return null;
  return html`<div class=${`subject level-${card.level}`}>
    <p><b class="mark">${app.subject}</b> <${Brief} app=${app} name=${app.subject} card=${card} /></p>
    <${SideEffects} app=${app} card=${card} />
    <${Orders} app=${app} name=${app.subject} card=${card} /></div>`;
}

/** The map's element, which preact draws once: the map itself draws its content. */
const MapElement = memo(({ app }) => {
  const element = useRef(null);
  useEffect(() => {
    app.openMap(element.current).catch((problem) => app.tell(`There is no map: ${problem.message}`));
    return () => app.closeMap();
  }, []);
  return html`<div id="map" ref=${element}></div>`;
});

function MapTools({ app }) {
  const chosen = useWatched(app.chosen);
  const only = useWatched(app.only);
  const following = useWatched(app.following);
  const measuring = useWatched(app.measuring);
  return html`<div class="map-tools" role="toolbar" aria-label="Map">
    <${Find} app=${app} />
    <button type="button" title="fit  F" onClick=${() => app.map?.fit()}>Fit</button>
    <button type="button" title="follow the chosen  O" aria-pressed=${String(following)} disabled=${chosen === null && only === null && !following} onClick=${() => app.following.set(!following)}>Follow</button>
    <button type="button" title="measure  R" aria-pressed=${String(measuring)} onClick=${() => app.measuring.set(!measuring)}>Measure</button>
    <${TargetFilter} app=${app} />
    ${chosen !== null && html`<button type="button" class="chosen-name" title="choose nothing  Esc" onClick=${() => app.chosen.set(null)}>${chosen} ×</button>`}
  </div>`;
}

const app = new App();
const place = document.getElementById("app");
place.replaceChildren();
render(html`<${Page} app=${app} />`, place);
listenForKeys(app);
new Announcer(app, document.body.insertBefore(document.createElement("div"), place)); // below the screen it would make the page scroll
app.link.connect();
