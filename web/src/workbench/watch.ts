// Watches the open files on the disk, and whether the program still runs.
//
// A watch occupies one of the six connections that a browser opens to an address. So of all hidden pages only one watches, because the program
// ends a while after the last watch; the others begin again when they are seen.

import type { WatchEvent } from "./protocol.ts";
import { type Transport, Gone, Locked, isAbort } from "./transport.ts";

export interface WatchHooks {
  /** Files with the hashes that the page knows. */
  files(): Record<string, string>;
  changed(file: string, text: string, hash: string): void;
  removed(file: string): void;
  unreadable(file: string, reason: string): void;
  /** The stream has begun, again if it had ended. */
  up(): void;
  /** The stream has ended. */
  down(): void;
  locked(): void;
}

/** Lock of the hidden page that watches. */
const HIDDEN = "gearloss-hidden-watch";

/** A stream without a line for so long has ended. [ms] */
const SILENCE = 15_000;

export class Watch {
  private running: AbortController | null = null;
  private retry = 0;
  private timer = 0;

  constructor(
    private readonly transport: Transport,
    private readonly hooks: WatchHooks,
  ) {
    document.addEventListener("visibilitychange", () => (document.hidden ? this.hide() : this.appear()));
  }

  /** Ends the turn of this page among the hidden ones; null while the page is seen. */
  private turn: AbortController | null = null;
  /** True if this page is hidden and has no turn. */
  private rests = false;
  private isBegun = false;

  /** Begins again with the present files. */
  restart(): void {
    this.isBegun = true;
    if (this.rests) return;
    if (document.hidden && !this.turn) return this.hide();
    this.stop();
    void this.follow();
  }

  private stop(): void {
    clearTimeout(this.timer);
    this.running?.abort();
    this.running = null;
  }

  /** Watches only when it is the turn of this page. */
  private hide(): void {
    if (!navigator.locks || this.turn || !this.isBegun) return;
    const own = new AbortController();
    this.turn = own;
    this.rests = true;
    this.stop();
    const turn = () =>
      new Promise<void>((done) => {
        if (own.signal.aborted) return done();
        own.signal.addEventListener("abort", () => done());
        this.rests = false;
        void this.follow();
      });
    navigator.locks.request(HIDDEN, { signal: own.signal }, turn).catch(() => undefined);
  }

  private appear(): void {
    if (!this.turn) return;
    this.turn.abort();
    this.turn = null;
    this.rests = false;
    this.restart();
  }

  private async follow(): Promise<void> {
    const own = new AbortController();
    this.running = own;
    let silent = false;
    let guard = 0;
    const heard = () => {
      clearTimeout(guard);
      guard = window.setTimeout(() => {
        silent = true;
        own.abort();
      }, SILENCE);
    };
    try {
      heard();
      for await (const event of this.transport.stream<WatchEvent>({ request: "watch", files: this.hooks.files() }, own.signal)) {
        heard();
        if (this.running !== own) return;
        this.retry = 0;
        this.hooks.up();
        if (event.event === "changed") this.hooks.changed(event.file, event.text, event.hash);
        if (event.event === "removed") this.hooks.removed(event.file);
        if (event.event === "unreadable") this.hooks.unreadable(event.file, event.reason);
      }
      throw new Gone("the stream ends");
    } catch (fault) {
      if (this.running !== own || (isAbort(fault) && !silent)) return;
      if (fault instanceof Locked) return this.hooks.locked();
      this.hooks.down();
      this.retry++;
      this.timer = window.setTimeout(() => void this.follow(), Math.min(10_000, 1000 * this.retry));
    } finally {
      clearTimeout(guard);
    }
  }
}
