// Unsaved texts in the storage of the browser, so that a reload, a crash or the end of the program loses nothing.
//
// Each tab has its own drafts: two tabs do not see each other's text. A lock with the name of the tab says that it is open; drafts of tabs that
// are not open any more are offered to the next one.

export interface Draft {
  file: string;
  text: string;
  /** Hash of the file on the disk from which the text was made; null for a new file. */
  hash: string | null;
  /** Text of that file, for a merge. */
  base: string;
  time: number;
}

const TAB = "gearloss-tab";
const PREFIX = "gearloss-draft";

export class Drafts {
  private constructor(
    private readonly folder: string,
    private readonly tab: string,
    private readonly alive: Set<string>,
  ) {}

  static async open(folder: string): Promise<Drafts> {
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
    return new Drafts(folder, tab, new Set(held.map((lock) => lock.name ?? "")));
  }

  /** Lets other tabs offer the drafts of this one, whose program has ended; or keeps them for this tab again. */
  share(is: boolean): void {
    if (is) unlock();
    else void locked(this.tab);
  }

  private key(file: string, tab = this.tab): string {
    return JSON.stringify([PREFIX, this.folder, tab, file]);
  }

  /** Drafts of this tab and of tabs that are not open any more; of each file the newest first. */
  kept(): { key: string; draft: Draft }[] {
    const found: { key: string; draft: Draft }[] = [];
    for (let k = 0; k < localStorage.length; k++) {
      const key = localStorage.key(k)!;
      if (!key.startsWith(`["${PREFIX}"`)) continue;
      try {
        const [, folder, tab] = JSON.parse(key);
        if (folder !== this.folder || (tab !== this.tab && this.alive.has(lockOf(tab)))) continue;
        found.push({ key, draft: JSON.parse(localStorage.getItem(key)!) });
      } catch {
        // Not one of ours.
      }
    }
    return found.sort((a, b) => b.draft.time - a.draft.time);
  }

  keep(draft: Omit<Draft, "time">): boolean {
    try {
      localStorage.setItem(this.key(draft.file), JSON.stringify({ ...draft, time: Date.now() }));
      return true;
    } catch {
      // The storage is full or forbidden.
      return false;
    }
  }

  drop(file: string): void {
    localStorage.removeItem(this.key(file));
  }

  dropKey(key: string): void {
    localStorage.removeItem(key);
  }
}

const lockOf = (tab: string) => `gearloss-tab-${tab}`;

/** Gives the lock of this tab back. */
let unlock: () => void = () => undefined;

/** Holds the lock of a tab until the page ends or gives it back; false if another page has it. */
function locked(tab: string): Promise<boolean> {
  if (!navigator.locks) return Promise.resolve(true);
  return new Promise((done) => {
    void navigator.locks.request(lockOf(tab), { ifAvailable: true }, (lock) => {
      done(lock !== null);
      return lock ? new Promise<void>((end) => (unlock = end)) : undefined;
    });
  });
}
