// Watches the open files on the disk, and whether the program still runs.

import type { WatchEvent } from "./protocol.ts";
import { type Transport, Gone, Locked, isAbort } from "./transport.ts";

export interface WatchHooks {
  /** Files with the hashes that the page knows. */
  files(): Record<string, string>;
  changed(file: string, text: string, hash: string): void;
  removed(file: string): void;
  /** The stream has begun, again if it had ended. */
  up(): void;
  /** The stream has ended. */
  down(): void;
  locked(): void;
}

/** A stream without a line for so long has ended. [ms] */
const SILENCE = 15_000;

export class Watch {
  private running: AbortController | null = null;
  private retry = 0;
  private timer = 0;

  constructor(
    private readonly transport: Transport,
    private readonly hooks: WatchHooks,
  ) {}

  /** Begins again with the present files. */
  restart(): void {
    clearTimeout(this.timer);
    this.running?.abort();
    void this.follow();
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
