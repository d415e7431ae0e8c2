// The Collision view: 21 values, answered while one types.
import { asked, drawInto, element, newest, page, settled, showList, showUnits, shown, stop, tabs } from "./ask.js";
import { formView } from "./form.js";

const view = formView("collision", {
  file: "scene",
  read: () => Object.fromEntries(view.inputs().map((input) => [input.name, input.value])),
  put: (input, text) => { input.value = text; },
  answer: () => answer(),
});
const { form, inputs, question, trouble } = view;

/** What stands between the form and an answer. */
function waitingFor(answer) {
  const wrong = Object.keys(answer.problems);
  const parts = [];
  if (answer.missing.length >= inputs().length - 1) {
    parts.push("Fill in the values, or begin with a published run or a kind of collision. The answer appears here while you type.");
  } else if (answer.missing.length) {
    parts.push(`Still to fill in: ${answer.missing.join(" ")}.`);
  }
  if (wrong.length) parts.push(`To be corrected: ${wrong.join(" ")}.`);
  if (parts.length && !page("collision-answer").hidden) parts.push("Below is the answer to the values before.");
  return parts.join(" ");
}

/** The Apple's screen: 24 rows of 40 characters, inverse and flashing ones as such. */
function showScreen(rows) {
  page("collision-apple").replaceChildren(...rows.map((runs) => element("span", { className: "row" },
    ...runs.map(([kind, text]) => (kind === "normal" ? text : element("span", { className: kind }, text))), "\n")));
}

function showAnswer(answer) {
  page("collision-answer").hidden = false;
  page("collision-signs").hidden = true;
  page("collision-more-signs").hidden = false;
  page("collision-first").innerHTML = answer.first;
  page("collision-screen").textContent = answer.page;
  showScreen(answer.screen);
  for (const note of document.querySelectorAll("#collision .nominal")) note.hidden = !answer.ranges.length;
  page("collision-warnings").querySelector("ul")
    .replaceChildren(...answer.warnings.map((text) => element("li", {}, text)));
  page("collision-warnings").hidden = !answer.warnings.length;
  page("collision-results").innerHTML = answer.all;
}

let latest = null;
const announce = settled(() => {
  const [{ words, unit, values: [a, b] }] = latest.answer;
  const said = `${words}: A ${a.text}, B ${b.text} ${unit}. `;
  page("collision-said").textContent = `${said}Warnings: ${latest.warnings.length}.`;
}, 1200);

const draw = newest(async () => {
  const picture = page("collision-figure");
  picture.parentElement.classList.toggle("stale", !await drawInto(picture, question()));
});

function showBounds({ found, table }) {
  page("collision-bounds-table").innerHTML = table;
  const warned = Object.entries(found.warnings).map(([name, share]) => `${shown(100 * share, 3)} % ${name}`);
  page("collision-bounds-note").textContent =
    `Lower and upper: extremes over all ranges, attained, sought in ${found.evaluations.toLocaleString("en")} scenes. `
    + `Quantiles: ${found.samples.toLocaleString("en")} draws, seed ${found.seed}. `
    + "Swing: how far a result goes while that input alone goes through its range."
    + (warned.length ? ` Draws with a warning: ${warned.join(", ")}.` : "");
}

const explore = settled(async () => {
  const note = page("collision-bounds-note");
  const sent = JSON.stringify(question());
  note.textContent = "Computing …";
  page("collision-bounds-stop").hidden = false;
  page("collision-bounds-table").classList.add("stale");
  let found = null;
  let problem = "Stopped.";
  try {
    found = await asked("bounds", JSON.parse(sent));
  } catch (error) {
    problem = error.message;
  }
  if (sent !== JSON.stringify(question())) return; // a newer one is on its way
  page("collision-bounds-stop").hidden = true;
  page("collision-bounds-table").classList.remove("stale");
  if (found) {
    showBounds(found);
  } else {
    note.textContent = problem;
    page("collision-bounds-table").replaceChildren();
  }
}, 350);

let exploring = false;
const answer = newest(async () => {
  let told;
  try {
    told = await asked("collision", question());
  } catch (error) {
    trouble(error);
    return;
  }
  trouble(null);
  view.showProblems(told.problems, told.ranges);
  showList(page("collision-remarks"), told.remarks);
  showUnits(form(), told.units);
  page("collision-base").textContent = told.units.base;
  const ranged = told.ranges.length > 0 && Boolean(told.oracle);
  if (exploring && !ranged) {
    explore.forget();
    stop("bounds");
  }
  exploring = ranged;
  const waiting = waitingFor(told);
  page("collision-waiting").textContent = waiting;
  page("collision-answer").classList.toggle("stale", Boolean(waiting));
  if (!told.oracle) return;
  page("collision-bounds").hidden = !ranged;
  latest = told;
  showAnswer(told);
  announce();
  draw();
  if (ranged) explore();
});

/** Start the view. */
export function collision() {
  view.start();
  form().addEventListener("input", (event) => {
    if (event.target.name) answer();
  });
  tabs(document.querySelector("#collision .tabs"));
  addEventListener("desk-scene", (event) => view.load(event.detail));
  page("collision-bounds-stop").addEventListener("click", () => stop("bounds"));
  answer();
}
