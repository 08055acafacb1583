// Unsaved texts, kept by the program so that a reload, a crash or the end of the program loses nothing.
//
// Nothing of them is in the storage of the browser: it belongs to the address, whose port another user of the computer may take when the program
// has ended. Each tab has its own drafts: two tabs do not see each other's text. A lock with the name of the tab says that it is open; drafts of
// tabs that are not open any more are offered to the next one.

import type { Draft, KeptDraft } from "./protocol.ts";
import { type Transport, Refused } from "./transport.ts";

const TAB = "gearloss-tab";

export class Drafts {
  /** Names of the drafts of this tab, by file. */
  private readonly ids = new Map<string, string>();
  /** What was kept last of each file. */
  private readonly last = new Map<string, string>();
  private queue: Promise<unknown> = Promise.resolve();

  private constructor(
    private readonly transport: Transport,
    private readonly tab: string,
    private readonly found: KeptDraft[],
  ) {
    for (const { id, tab: of, draft } of found) if (of === tab) this.ids.set(draft.file, id);
  }

  static async open(transport: Transport): Promise<Drafts> {
    let tab = sessionStorage.getItem(TAB) ?? "";
    // The page before a reload gives its lock back a moment later; a duplicated tab keeps it.
    for (let round = 0; tab && !(await locked(tab)); round++) {
      if (round === 5) tab = "";
      else await new Promise((done) => setTimeout(done, 40));
    }
    if (!tab) {
      tab = [...crypto.getRandomValues(new Uint8Array(8))].map((b) => b.toString(16).padStart(2, "0")).join("");
      sessionStorage.setItem(TAB, tab);
      await locked(tab);
    }
    const held = navigator.locks ? ((await navigator.locks.query()).held ?? []) : [];
    const alive = new Set(held.map((lock) => lock.name ?? ""));
    const all = await transport.ask({ request: "drafts" });
    return new Drafts(transport, tab, all.filter((own) => own.tab === tab || !alive.has(lockOf(own.tab))));
  }

  /** Drafts of this tab and of tabs that are not open any more, as they were when the page was opened; the newest first. */
  kept(): KeptDraft[] {
    return [...this.found].sort((a, b) => b.draft.time - a.draft.time);
  }

  /** Keeps a text; says why it cannot be kept. */
  keep(draft: Omit<Draft, "time">): Promise<string | null> {
    const { file } = draft;
    const sign = JSON.stringify(draft);
    if (this.last.get(file) === sign) return Promise.resolve(null);
    this.last.set(file, sign);
    return this.next(async () => {
      // A newer text takes the place of this one.
      if (this.last.get(file) !== sign) return null;
      try {
        const { id } = await this.transport.ask({ request: "keep", tab: this.tab, draft: { ...draft, time: Date.now() } });
        this.ids.set(file, id);
      } catch (fault) {
        this.last.delete(file);
        // That the program has ended the page says itself.
        return fault instanceof Refused ? fault.message : null;
      }
      return null;
    });
  }

  /** Forgets what this tab has kept of a file. */
  drop(file: string): void {
    this.last.delete(file);
    void this.next(async () => {
      const id = this.ids.get(file);
      if (id) await this.forget(id);
    });
  }

  /** Forgets a draft. */
  dropKept({ id, draft }: KeptDraft): void {
    if (this.ids.get(draft.file) === id) this.last.delete(draft.file);
    void this.next(() => this.forget(id));
  }

  private async forget(id: string): Promise<void> {
    for (const [file, own] of this.ids) if (own === id) this.ids.delete(file);
    await this.transport.ask({ request: "forget", id }).catch(() => undefined);
  }

  /** One after the other, so that what is forgotten stays so. */
  private next<T>(act: () => Promise<T>): Promise<T> {
    const done = this.queue.then(act);
    this.queue = done.catch(() => undefined);
    return done;
  }
}

const lockOf = (tab: string) => `gearloss-tab-${tab}`;

/** Holds the lock of a tab until the page ends; false if another page has it. */
function locked(tab: string): Promise<boolean> {
  if (!navigator.locks) return Promise.resolve(true);
  return new Promise((done) => {
    void navigator.locks.request(lockOf(tab), { ifAvailable: true }, (lock) => {
      done(lock !== null);
      return lock ? new Promise<void>(() => undefined) : undefined;
    });
  });
}
