// The page: which view is shown, and the views themselves.
import { page, stopAll } from "./ask.js";
import { collision } from "./collision.js";
import { paper } from "./paper.js";
import { reconstruction } from "./reconstruction.js";

const VIEWS = ["paper", "collision", "reconstruction"];

function show() {
  const wanted = location.hash.slice(1);
  const name = VIEWS.includes(wanted) ? wanted : VIEWS[0];
  for (const view of VIEWS) {
    page(view).hidden = view !== name;
    const link = document.querySelector(`nav a[href="#${view}"]`);
    if (view === name) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  }
  document.title = `${page(`${name}-heading`).textContent} · impact88 desk`;
}

// "Skip to the content" is a place in the view shown, not a view
document.querySelector(".skip").addEventListener("click", (event) => {
  event.preventDefault();
  page("main").focus();
});
addEventListener("hashchange", () => {
  show();
  scrollTo(0, 0);
  page("main").focus({ preventScroll: true });
});
addEventListener("pagehide", stopAll);
show();
paper();
collision();
reconstruction();
