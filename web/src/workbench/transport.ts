// How the page reaches the program. The page knows only the interface, so that a program inside of the page can take its place.

import type { Answers, Fault, Request } from "./protocol.ts";

type Named<N> = Extract<Request, { request: N }>;
type Single = Exclude<Request["request"], "run" | "watch">;

export interface Transport {
  /** The answer to one request. Rejects with `Refused`, `Locked`, `Gone`, or an `AbortError`. */
  ask<N extends Single & keyof Answers>(request: Named<N>, signal?: AbortSignal): Promise<Answers[N]>;
  /** The events that answer `run` and `watch`, one after the other. */
  stream<E>(request: Named<"run"> | Named<"watch">, signal?: AbortSignal): AsyncIterable<E>;
}

/** The program answers that it cannot. */
export class Refused extends Error {
  constructor(readonly fault: Fault) {
    super(fault.message);
  }
}

/** The token is absent or not that of the program. */
export class Locked extends Error {}

/** The program does not answer any more. */
export class Gone extends Error {}

export function isAbort(fault: unknown): boolean {
  return fault instanceof DOMException && fault.name === "AbortError";
}

/** How long the program that answered last is known to be there without an open stream. [ms] */
const FRESH = 2000;

/** How often a request is repeated that the program was too busy to answer. */
const REPEATS = 5;

/** Length up to which a browser sends a request while its page is closed. [byte] */
const LAST_WORDS = 60_000;

/**
 * Over HTTP, with a token. Requests carry texts that are not saved. When the program has ended, another user of the computer may listen on its
 * port; so each answer of the program states a secret, which this page keeps in its memory alone, and without a sign of the program a request
 * that carries nothing goes first.
 */
export class Http implements Transport {
  private proof: string | null = null;
  private heard = -Infinity;
  private streams = 0;

  constructor(private readonly token: string | null) {}

  private async send(request: Request, signal?: AbortSignal): Promise<Response> {
    if (this.streams === 0 && performance.now() - this.heard > FRESH) await this.post({ request: "hello" }, signal);
    for (let k = 0; ; k++) {
      const response = await this.post(request, signal);
      if (response.status !== 503 || k === REPEATS) return response;
      await new Promise((done) => setTimeout(done, 1000 * Number(response.headers.get("Retry-After") ?? 1)));
      signal?.throwIfAborted();
    }
  }

  private async post(request: Request, signal?: AbortSignal): Promise<Response> {
    if (!this.token) throw new Locked("no token");
    const body = JSON.stringify(request);
    let response: Response;
    try {
      response = await fetch("/api", {
        method: "POST",
        headers: { "Content-Type": "application/json", Authorization: `Bearer ${this.token}` },
        body,
        cache: "no-store",
        keepalive: request.request === "keep" && new Blob([body]).size < LAST_WORDS,
        signal,
      });
    } catch (fault) {
      if (isAbort(fault)) throw fault;
      this.heard = -Infinity;
      throw new Gone("no answer");
    }
    const proof = response.headers.get("Gearloss-Proof");
    if (response.status === 401 || response.status === 403 || proof === null || (this.proof !== null && proof !== this.proof)) {
      this.heard = -Infinity;
      throw new Locked(`status ${response.status}`);
    }
    this.proof = proof;
    this.heard = performance.now();
    return response;
  }

  async ask<N extends Single & keyof Answers>(request: Named<N>, signal?: AbortSignal): Promise<Answers[N]> {
    const response = await this.send(request, signal);
    let answer: { value: Answers[N] } | { fault: Fault };
    try {
      answer = await response.json();
    } catch (fault) {
      if (isAbort(fault)) throw fault;
      if (response.ok) throw new Gone("the answer ends early");
      throw new Refused({ message: `the program answers with status ${response.status}`, help: null, findings: [] });
    }
    if ("fault" in answer) throw new Refused(answer.fault);
    return answer.value;
  }

  async *stream<E>(request: Named<"run"> | Named<"watch">, signal?: AbortSignal): AsyncIterable<E> {
    const response = await this.send(request, signal);
    if (!response.ok || !response.body) throw new Refused({ message: `the program answers with status ${response.status}`, help: null, findings: [] });
    const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
    let rest = "";
    this.streams++;
    try {
      for (;;) {
        let part: ReadableStreamReadResult<string>;
        try {
          part = await reader.read();
        } catch (fault) {
          if (isAbort(fault) || signal?.aborted) throw new DOMException("aborted", "AbortError");
          this.heard = -Infinity;
          throw new Gone("the stream ends early");
        }
        if (part.done) break;
        const lines = (rest + part.value).split("\n");
        rest = lines.pop() ?? "";
        for (const line of lines) if (line.trim()) yield JSON.parse(line) as E;
      }
      if (rest.trim()) yield JSON.parse(rest) as E;
    } finally {
      this.streams--;
    }
  }
}

/** Tells when the program keeps the page waiting. */
export class Patient implements Transport {
  private readonly late = new Set<object>();

  constructor(
    private readonly inner: Transport,
    /** Time until a request without an answer is late. [ms] */
    private readonly patience: number,
    /** Whether any request is late. */
    private readonly waiting: (is: boolean) => void,
  ) {}

  async ask<N extends Single & keyof Answers>(request: Named<N>, signal?: AbortSignal): Promise<Answers[N]> {
    // A fine map takes its time and says so itself.
    if ((request as Request).request === "map") return this.inner.ask(request, signal);
    const timer = setTimeout(() => {
      this.late.add(request);
      this.waiting(true);
    }, this.patience);
    try {
      return await this.inner.ask(request, signal);
    } finally {
      clearTimeout(timer);
      if (this.late.delete(request) && this.late.size === 0) this.waiting(false);
    }
  }

  stream<E>(request: Named<"run"> | Named<"watch">, signal?: AbortSignal): AsyncIterable<E> {
    return this.inner.stream<E>(request, signal);
  }
}

/** One kind of request, of which only the newest counts: a new one aborts the one before. */
export class Newest {
  private running: AbortController | null = null;

  constructor(private readonly transport: Transport) {}

  /** The answer, or null if a newer request took its place. */
  async ask<N extends Single & keyof Answers>(request: Named<N>): Promise<Answers[N] | null> {
    this.abort();
    const own = new AbortController();
    this.running = own;
    try {
      const answer = await this.transport.ask(request, own.signal);
      return this.running === own ? answer : null;
    } catch (fault) {
      if (isAbort(fault) || this.running !== own) return null;
      throw fault;
    } finally {
      if (this.running === own) this.running = null;
    }
  }

  abort(): void {
    this.running?.abort();
    this.running = null;
  }
}

const KEY = "gearloss-token";

/** The token of the address, which it leaves, or the one of this tab. */
export function tokenOfPage(): string | null {
  const given = /^#t=([0-9a-fA-F]+)$/.exec(location.hash)?.[1];
  if (given) {
    history.replaceState(null, "", location.pathname + location.search);
    sessionStorage.setItem(KEY, given);
    return given;
  }
  return sessionStorage.getItem(KEY);
}
