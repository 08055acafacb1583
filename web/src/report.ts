// The report page: draws its pictures when they come into view, equips its tables, follows the navigation, prepares printing.

import { Drawn, Picture, colourBooks, draw } from "./draw.ts";
import { colourByLoss, heatScale, largest, legible } from "./drawing.ts";
import { words } from "./format.ts";
import { html } from "./svg.ts";
import { equip } from "./table.ts";
import { theme } from "./theme.ts";

const data: Record<string, Picture> = JSON.parse(document.getElementById("pictures")?.textContent || "{}");
const books = colourBooks(Object.values(data));

const drawn = new Map<HTMLElement, Drawn>();
const hosts = [...document.querySelectorAll<HTMLElement>("[data-picture]")];

function show(host: HTMLElement, width?: number, height?: number): void {
  const picture = data[host.dataset.picture ?? ""];
  if (!picture || drawn.has(host)) return;
  host.replaceChildren();
  const own = host.dataset.height ? host.clientHeight || undefined : undefined;
  try {
    drawn.set(host, draw(host, picture, { ...books, width, height: height ?? own }));
    host.dataset.drawn = "";
  } catch (fault) {
    host.textContent = "This picture cannot be drawn.";
    console.error(fault);
  }
}

/** True while the page is prepared for paper. */
let onPaper = false;

/** Plot height of the picture on the first screen, whose box has a given size. */
function fit(host: HTMLElement): void {
  const room = host.clientHeight;
  const picture = drawn.get(host);
  if (!picture || room < 120 || onPaper) return;
  // Controls and legends take a part of the height, which is known after drawing.
  for (let round = 0; round < 3; round++) {
    const used = host.firstElementChild?.getBoundingClientRect().height ?? room;
    if (used <= room && used > room - 24) return;
    const before = Number(host.dataset.plot ?? room);
    const next = Math.max(150, before - (used - room));
    host.dataset.plot = String(next);
    picture.redraw({ height: next });
  }
}

function lazily(): void {
  const watcher = new IntersectionObserver(
    (entries) => {
      for (const entry of entries) {
        if (!entry.isIntersecting) continue;
        const host = entry.target as HTMLElement;
        watcher.unobserve(host);
        show(host);
        if (host.dataset.height) fit(host);
      }
    },
    { rootMargin: "600px 0px" },
  );
  for (const host of hosts) watcher.observe(host);
  // The room also changes with the lines of the navigation, which are known late.
  const room = new ResizeObserver((entries) => {
    for (const entry of entries) fit(entry.target as HTMLElement);
  });
  for (const host of hosts) if (host.dataset.height) room.observe(host);
}

function tables(): void {
  for (const table of document.querySelectorAll<HTMLTableElement>(".table table")) {
    const name = table.caption?.textContent?.trim() || table.closest("section")?.querySelector("h2")?.textContent?.trim() || "table";
    equip(table, name);
  }
}

function navigation(): void {
  const bar = document.querySelector<HTMLElement>("nav");
  // The first screen and jumps leave room for it, in as many lines as it has.
  if (bar) new ResizeObserver(() => document.documentElement.style.setProperty("--nav", `${bar.offsetHeight}px`)).observe(bar);
  const links = new Map([...document.querySelectorAll<HTMLAnchorElement>("nav a[href^='#']")].map((a) => [decodeURIComponent(a.hash.slice(1)), a]));
  const visible = new Set<string>();
  const watcher = new IntersectionObserver(
    (entries) => {
      for (const { target, isIntersecting } of entries) {
        if (isIntersecting) visible.add(target.id);
        else visible.delete(target.id);
      }
      const current = [...links.keys()].find((id) => visible.has(id));
      if (!current && scrollY < innerHeight / 2) [...links.values()][0]?.closest("ol")?.scrollTo(0, 0);
      for (const [id, link] of links) {
        if (id !== current) link.removeAttribute("aria-current");
        else if (!link.hasAttribute("aria-current")) {
          link.setAttribute("aria-current", "true");
          // Only the bar itself moves, not the page.
          const bar = link.closest("ol");
          if (bar) bar.scrollLeft = link.offsetLeft - bar.clientWidth / 2 + link.offsetWidth / 2;
        }
      }
    },
    { rootMargin: "-80px 0px -70% 0px" },
  );
  for (const id of links.keys()) {
    const section = document.getElementById(id);
    if (section) watcher.observe(section);
  }
  document.addEventListener("click", (event) => {
    const link = (event.target as Element).closest<HTMLAnchorElement>("a[href^='#']");
    if (link) ready(link.hash);
  });
  addEventListener("hashchange", () => ready(location.hash));
  if (location.hash) ready(location.hash)?.scrollIntoView();
}

/** Prepares a jump: opens the details around the target, and draws the pictures before it, so that its place does not change any more. */
function ready(hash: string): Element | null {
  const target = document.getElementById(decodeURIComponent(hash.slice(1)));
  if (!target) return null;
  for (let e = target.parentElement; e; e = e.parentElement) if (e instanceof HTMLDetailsElement) e.open = true;
  for (const host of hosts) {
    const before = host.compareDocumentPosition(target) & Node.DOCUMENT_POSITION_FOLLOWING;
    if (before && !host.closest("details:not([open])")) show(host);
  }
  return target;
}

/** Width of one of two columns in pixels: paper shows pictures at 80 % of their size, and A4 has 703 pixels between its margins. */
const COLUMN = 430;
/** Width of the first picture beside the drawing: the style sheet gives it 420 pixels on paper. */
const LEAD = 525;

/** Height of the plots on paper, so that four rows of pictures fit on a page, and a pane or a row of three panels is still legible; rows of
 * names have their usual height. */
function paperHeight(picture: Picture, wide: boolean): number | undefined {
  switch (picture?.kind) {
    case "panels":
      return 205 * Math.ceil((picture.rows.length * picture.columns.length) / 3);
    case "panes":
      return 75 * picture.panes.length;
    case "map":
    case "cloud":
    case "lines":
    case "areas":
    case "bars":
    case "waterfall":
      return wide ? 290 : 235;
    default:
      return undefined;
  }
}

function printing(): void {
  // The title is the head of each page but the first.
  const title = document.title.replace(/["\\\n<]/g, (c) => `\\${c.charCodeAt(0).toString(16)} `);
  html(document.head, "style", {}, `@page { @top-left { content: "${title}"; } } @page :first { @top-left { content: none; } }`);
  let closed: HTMLDetailsElement[] = [];
  const before = () => {
    if (onPaper) return;
    onPaper = true;
    for (const host of hosts) {
      const wide = host.closest(".wide, .first") !== null;
      const [lead, picture] = [host.dataset.height !== undefined, data[host.dataset.picture ?? ""]];
      const width = lead && document.querySelector(".lead:not(.one)") ? LEAD : wide ? 2 * COLUMN + 15 : COLUMN;
      const height = lead ? 225 : paperHeight(picture, wide);
      if (drawn.has(host)) drawn.get(host)!.redraw({ width, height });
      else show(host, width, height);
    }
    closed = [...document.querySelectorAll<HTMLDetailsElement>("details:not([open])")].filter((d) => !d.classList.contains("source"));
    for (const details of closed) details.open = true;
  };
  const after = () => {
    if (!onPaper) return;
    onPaper = false;
    for (const details of closed) details.open = false;
    for (const [host, picture] of drawn) {
      picture.redraw({ width: undefined, height: host.dataset.height ? Number(host.dataset.plot ?? host.clientHeight) || undefined : undefined });
      if (host.dataset.height) fit(host);
    }
  };
  addEventListener("beforeprint", before);
  addEventListener("afterprint", after);
  document.getElementById("print")?.addEventListener("click", () => print());
}

/** Words of the data in the field's typography: units, and names between backticks. */
function typography(): void {
  for (const element of document.querySelectorAll("[data-words], td, th, figcaption")) {
    // Copies and files keep the text as it was.
    if (element instanceof HTMLTableCellElement) element.dataset.text = element.textContent?.trim() ?? "";
    // The first head names what the rows are; others may be mechanisms.
    if (element instanceof HTMLTableCellElement && element.tagName === "TH" && element.cellIndex === 0) continue;
    for (const node of [...element.childNodes]) {
      if (node.nodeType !== Node.TEXT_NODE || !node.nodeValue) continue;
      const parts = words(node.nodeValue).split(/`([^`\n]+)`/);
      if (parts.length === 1) {
        if (parts[0] !== node.nodeValue) node.nodeValue = parts[0];
        continue;
      }
      const pieces = parts.map((part, k) => {
        if (k % 2 === 0) return part;
        const code = document.createElement("code");
        code.textContent = part;
        return code;
      });
      (node as ChildNode).replaceWith(...pieces);
    }
  }
}

/** Pictures in two columns: wide ones over both, and no gap beside a single one. */
function arrange(): void {
  for (const group of document.querySelectorAll(".pictures")) {
    const figures = [...group.querySelectorAll<HTMLElement>(":scope > figure")];
    let run: HTMLElement[] = [];
    const close = () => {
      if (run.length % 2) run[0].classList.add("wide");
      run = [];
    };
    for (const figure of figures) {
      const picture = data[figure.querySelector<HTMLElement>("[data-picture]")?.dataset.picture ?? ""];
      const own = picture?.kind === "panes" || (picture?.kind === "panels" && picture.rows.length * picture.columns.length > 1);
      figure.classList.toggle("wide", own);
      figure.classList.toggle("spread", own);
      if (own) close();
      else run.push(figure);
    }
    close();
  }
}

/** Drawings of gearboxes, coloured by the losses at the point of the report. */
function drawings(): void {
  for (const drawing of document.querySelectorAll<HTMLElement>(".drawing[data-losses]")) {
    const losses = JSON.parse(drawing.dataset.losses || "[]");
    const most = colourByLoss(drawing, losses);
    const own = drawing.querySelector("svg");
    if (own) new ResizeObserver(() => legible(own)).observe(drawing);
    const note = drawing.parentElement?.querySelector(".loss-note");
    if (!most || !note) continue;
    heatScale(note, most[1]);
    html(note, "p", {}, `Loss at ${words(drawing.dataset.at ?? "")}. ${largest(losses, most)}`);
  }
}

document.documentElement.classList.add("script");
const colours = document.getElementById("theme");
if (colours) theme(colours);
typography();
tables();
arrange();
drawings();
navigation();
printing();
lazily();
