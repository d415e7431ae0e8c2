// What the forms of Collision and Reconstruction share: everything a file holds, its units, opening and saving.
import { ask, asked, attempt, element, page, save, tell, watched } from "./ask.js";

const ABOUT = ["title", "case", "examiner", "date"];

/**
 * A form named `view`. `read` gives the texts that count by name, `put` shows one at its field, `answer` asks anew;
 * `loaded` is called with a file or what one begins with, once it stands in the form.
 */
export function formView(view, { file, read, put, answer, loaded = () => {} }) {
  const at = (part) => page(`${view}-${part}`);
  const form = () => at("form");
  const inputs = () => [...form().querySelectorAll("fieldset input[name]")];
  let extra = {}; // what a file has beside the fields: computed with, and saved again
  let units = ""; // the system that the numbers in the form are in

  const about = () => Object.fromEntries(
    ABOUT.map((name) => [name, at(name).value.trim()]).filter(([, text]) => text));
  const beside = () => ({ ...extra, ...about() });
  const question = () => ({ values: { ...beside(), ...read() }, title: at("title").value, units: at("units").value });
  const trouble = (error) => tell(at("trouble"), error);
  const doing = (work) => attempt(work, trouble);

  /** What the form has no field for, each with a button that drops it. */
  function showExtra() {
    const entries = Object.entries(extra).map(([name, text]) => {
      const drop = element("button", { type: "button", "aria-label": `Drop ${name}` }, "Drop");
      drop.addEventListener("click", () => {
        delete extra[name];
        delete extra[`${name}_source`];
        showExtra();
        answer();
      });
      return element("li", {}, element("code", {}, `${name} = "${text}" `), drop);
    });
    at("extra").querySelector("ul").replaceChildren(...entries);
    at("extra").hidden = !entries.length;
  }

  /** What is wrong with each value, at its field; `ranges`: names known within limits. */
  function showProblems(problems, ranges = []) {
    tell(at("units-problem"), problems.units && { message: problems.units });
    for (const input of inputs()) {
      const problem = problems[input.name];
      tell(page(`${input.id}-problem`), problem && { message: problem });
      if (problem) input.setAttribute("aria-invalid", "true");
      else input.removeAttribute("aria-invalid");
      input.classList.toggle("range", ranges.includes(input.name));
    }
  }

  function load(given) {
    extra = { ...given.extra };
    for (const name of ABOUT) {
      at(name).value = extra[name] ?? "";
      delete extra[name];
    }
    at("title").value = given.title ?? "";
    for (const input of inputs()) {
      put(input, given.values[input.name] ?? "");
      input.placeholder = given.values[input.name] === "" ? "to fill in" : "";
    }
    tell(at("hint"), given.hint && { message: given.hint });
    units = given.units ?? "";
    at("units").value = units;
    at("asks").hidden = true;
    showExtra();
    loaded(given);
    answer();
  }

  const words = (system) => [...at("units").options].find((option) => option.value === system).textContent;

  /** Other units: what stands in the form is converted, or read anew. */
  function changeUnits() {
    const to = at("units").value;
    if (!units || !to || !inputs().some((input) => input.name !== "M" && input.value.trim())) {
      units = to;
      answer();
      return;
    }
    at("asks-words").textContent = `The numbers in the form are in ${words(units)}. In ${words(to)}:`;
    at("asks").hidden = to === units;
  }

  function settle(system) {
    units = system;
    at("units").value = system;
    at("asks").hidden = true;
    answer();
  }

  /** Start the form. */
  function start() {
    form().addEventListener("submit", (event) => event.preventDefault());
    at("begin").addEventListener("change", (event) => {
      const address = event.target.value;
      event.target.value = "";
      if (address) doing(async () => load(await asked(address)));
    });
    at("units").addEventListener("change", changeUnits);
    at("reread").addEventListener("click", () => settle(at("units").value));
    at("stay").addEventListener("click", () => settle(units));
    at("convert").addEventListener("click", () => doing(async () => {
      const to = at("units").value;
      const all = { ...question(), units, values: { ...beside(), ...read(true) }, to };
      const { values } = await asked("convert", all);
      for (const input of inputs()) put(input, values[input.name] ?? "");
      for (const name of Object.keys(extra)) extra[name] = values[name] ?? extra[name];
      showExtra();
      settle(to);
    }));
    at("open").addEventListener("click", () => at("file").click());
    at("file").addEventListener("change", (event) => {
      const [chosen] = event.target.files;
      if (!chosen) return;
      doing(async () => {
        load(await asked(file, chosen, { name: chosen.name }));
        at("file").value = "";
      });
    });
    at("save").addEventListener("click", () => doing(async () => save(await ask(`file/${view}`, question()))));
    at("report").addEventListener("click", () => doing(async () => {
      const writing = ask(`case-report/${view}`, question());
      const response = await watched(at("busy"), "Writing the report", "report", writing);
      if (!response) return;
      await save(response);
      const name = response.headers.get("X-Case-File");
      tell(at("hint"), { message: `The report names the file ${name} by its SHA-256: save that, too, and keep both.` });
    }));
    at("print").addEventListener("click", () => print());
  }

  return { at, form, inputs, beside, question, trouble, showProblems, load, start };
}
