// Asking the desk: questions to the program on this machine, and small helpers for its answers.

const ID = crypto.randomUUID();
let turn = 0; // requests arrive in any order: each says which it is
const STOPPABLE = ["paper", "edit", "bounds", "reconstruction", "report"];

/** Input that cannot be used, or a fault; the message is the program's sentence. */
export class Problem extends Error {}

/** The element with an id. */
export function page(id) {
  return document.getElementById(id);
}

/** Who asks, and in which turn. */
function sender() {
  turn += 1;
  return { "X-Desk-Page": ID, "X-Desk-Turn": String(turn) };
}

/** An element with properties (or attributes) and children; texts stay texts. */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name in made) made[name] = value;
    else made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

/**
 * The response to a question; null when a newer question has replaced it.
 * Throws Problem with what is wrong.
 */
export async function ask(path, body, query = {}) {
  const address = new URL(path, document.baseURI.replace(/#.*/, ""));
  for (const [name, value] of Object.entries(query)) address.searchParams.set(name, value);
  const raw = body instanceof Blob || typeof body === "string";
  let response;
  try {
    response = await fetch(address, {
      method: "POST",
      headers: { ...sender(), "Content-Type": raw ? "application/octet-stream" : "application/json" },
      body: raw ? body : JSON.stringify(body ?? {}),
    });
  } catch {
    page("lost").hidden = false;
    throw new Problem("The desk does not answer.");
  }
  page("lost").hidden = true;
  if (response.status === 409) return null;
  if (!response.ok) {
    const told = await response.json().catch(() => ({}));
    throw new Problem(told.problem ?? `The desk refused the question (${response.status}).`);
  }
  return response;
}

/** The JSON object that answers a question; null when a newer one has replaced it. */
export async function asked(path, body, query) {
  const response = await ask(path, body, query);
  return response && response.json();
}

/** End what one kind of long work is computing for this page. */
export function stop(bench) {
  return ask(`stop/${bench}`).catch(() => {});
}

/** End everything, as the page goes away. */
export function stopAll() {
  for (const bench of STOPPABLE) {
    fetch(`stop/${bench}`, { method: "POST", headers: sender(), keepalive: true }).catch(() => {});
  }
}

/**
 * A function that does `work` for the newest call only: calls that come while it is at work are one
 * more time afterwards.
 */
export function newest(work) {
  let running = false;
  let again = false;
  return async function run() {
    if (running) {
      again = true;
      return;
    }
    running = true;
    try {
      do {
        again = false;
        await work();
      } while (again);
    } finally {
      running = false;
    }
  };
}

/** A function that does `work` once nobody has called it for `pause` milliseconds. */
export function settled(work, pause) {
  let timer;
  const later = () => {
    clearTimeout(timer);
    timer = setTimeout(work, pause);
  };
  later.forget = () => clearTimeout(timer);
  return later;
}

/** Let the browser save a response under the name it was sent with. */
export async function save(response) {
  const name = /filename="([^"]+)"/.exec(response.headers.get("Content-Disposition") ?? "");
  const address = URL.createObjectURL(await response.blob());
  const link = element("a", { href: address, download: name ? name[1] : "" });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/** Fill a table named `name`: `heads` are texts, `rows` lists of texts or nodes; the first cell heads its row. */
export function fill(table, name, heads, rows, classOf = () => "") {
  const head = element("tr", {}, ...heads.map((text) => element("th", { scope: "col" }, text)));
  const body = rows.map((row, place) =>
    element("tr", { className: classOf(place) }, ...row.map((cell, column) =>
      (column ? element("td", {}, cell) : element("th", { scope: "row" }, cell)))));
  const caption = element("caption", { className: "visually-hidden" }, name);
  table.replaceChildren(caption, element("thead", {}, head), element("tbody", {}, ...body));
}

/**
 * What `work` gives; while it takes longer than a second, `place` shows what is `doing`, for how long, and a button
 * that ends it on its bench.
 */
export async function watched(place, doing, bench, work) {
  const began = performance.now();
  const words = element("span", { role: "status" });
  const button = element("button", { type: "button" }, "Stop");
  button.addEventListener("click", () => stop(bench));
  const show = () => {
    const seconds = Math.floor((performance.now() - began) / 1000);
    if (!seconds) return;
    words.textContent = `${doing}, ${seconds} s `;
    if (!words.isConnected) place.replaceChildren(element("progress", { "aria-label": doing }), " ", words, button);
    place.hidden = false;
  };
  const timer = setInterval(show, 500);
  try {
    return await work;
  } finally {
    clearInterval(timer);
    if (words.isConnected) place.replaceChildren();
  }
}

/** A number for a table, to so many significant digits; nothing for none. */
export function shown(value, digits = 5) {
  return value === null || value === undefined ? "" : String(Number(value.toPrecision(digits)));
}

/** Name the units that a form's bare numbers are in, at its fields. */
export function showUnits(form, units) {
  for (const place of form.querySelectorAll("[data-rule]")) {
    const { rule } = place.dataset;
    place.textContent = rule === "1" ? "" : units.labels[rule] ?? rule;
  }
}

/** Show an error's sentence in a place, or hide the place. */
export function tell(place, error) {
  place.textContent = error ? error.message : "";
  place.hidden = !error;
}

/** Show texts as the items of a list, which is hidden where there is none. */
export function showList(list, texts) {
  list.replaceChildren(...texts.map((text) => element("li", {}, text)));
  list.hidden = !texts.length;
}

/** Do some work; what goes wrong with it is told, and what went wrong before no longer. */
export async function attempt(work, trouble) {
  try {
    trouble(null);
    await work();
  } catch (error) {
    trouble(error);
  }
}

/** Draw a scene into a picture; false where it cannot be drawn. */
export async function drawInto(picture, question) {
  let response = null;
  try {
    response = await ask("figure", question);
  } catch {
    // the answer has said what is wrong with the values
  }
  if (!response) return false;
  const blob = await response.blob();
  const drawing = new DOMParser().parseFromString(await blob.text(), "image/svg+xml");
  picture.alt = drawing.querySelector("desc")?.textContent ?? "The scene from above";
  const before = picture.src;
  const address = URL.createObjectURL(blob);
  picture.src = address;
  await picture.decode().catch(() => {});
  if (before.startsWith("blob:")) URL.revokeObjectURL(before);
  return true;
}

/** Let the buttons of a list of tabs choose between their panels, with arrow keys too. */
export function tabs(list) {
  const buttons = [...list.querySelectorAll("[role=tab]")];
  const choose = (chosen) => {
    for (const button of buttons) {
      button.setAttribute("aria-selected", String(button === chosen));
      button.tabIndex = button === chosen ? 0 : -1;
      page(button.getAttribute("aria-controls")).hidden = button !== chosen;
    }
  };
  list.addEventListener("click", (event) => buttons.includes(event.target) && choose(event.target));
  list.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    const next = buttons[(buttons.indexOf(event.target) + step + buttons.length) % buttons.length];
    choose(next);
    next.focus();
  });
}
