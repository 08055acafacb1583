// When to ask again while something changes quickly.

/** Time and timers, replaced in tests. */
export interface Clock {
  now(): number;
  later(act: () => void, ms: number): unknown;
  cancel(timer: unknown): void;
}

export const CLOCK: Clock = {
  now: () => performance.now(),
  later: (act, ms) => setTimeout(act, ms),
  cancel: (timer) => clearTimeout(timer as number),
};

/** Calls `act` once it was quiet for a time. */
export class Quiet {
  private timer: unknown = null;

  constructor(
    private readonly ms: number,
    private readonly act: () => void,
    private readonly clock: Clock = CLOCK,
  ) {}

  call(): void {
    this.cancel();
    this.timer = this.clock.later(() => {
      this.timer = null;
      this.act();
    }, this.ms);
  }

  cancel(): void {
    if (this.timer !== null) this.clock.cancel(this.timer);
    this.timer = null;
  }

  /** Does now what is waiting. */
  flush(): void {
    if (this.timer === null) return;
    this.cancel();
    this.act();
  }
}

/**
 * Calls `act` soon after a change, also while changes go on: the first change waits `ms`, and changes until then are one. While an act is not
 * finished, the next one waits for it, but not longer than `patience`; the one that then begins makes the unfinished one superfluous.
 */
export class Pace {
  private timer: unknown = null;
  private running = 0;
  private begun = -Infinity;
  private generation = 0;

  constructor(
    private readonly ms: number,
    private readonly patience: number,
    private readonly act: () => Promise<void>,
    private readonly clock: Clock = CLOCK,
  ) {}

  call(): void {
    if (this.timer === null) this.timer = this.clock.later(() => this.due(), this.ms);
  }

  private due(): void {
    const waited = this.clock.now() - this.begun;
    if (this.running > 0 && waited < this.patience) {
      this.timer = this.clock.later(() => this.due(), this.patience - waited);
      return;
    }
    this.timer = null;
    const own = ++this.generation;
    this.running = own;
    this.begun = this.clock.now();
    const done = () => {
      if (this.running !== own) return;
      this.running = 0;
      // What waited for this one begins.
      if (this.timer !== null) {
        this.clock.cancel(this.timer);
        this.due();
      }
    };
    this.act().then(done, done);
  }
}
