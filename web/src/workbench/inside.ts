// The program inside of the page: WebAssembly instead of a server, with files that live as long as the page.

import type { Answers, Fault, Request } from "./protocol.ts";
import { Refused, type Transport } from "./transport.ts";

type Named<N> = Extract<Request, { request: N }>;

/** What `web/demo` exports. */
interface Program {
  memory: WebAssembly.Memory;
  __wasm_call_ctors?: () => void;
  allocate(length: number): number;
  answer(place: number): number;
  release(place: number): void;
}

/** Length of the length before an answer. */
const HEAD = 4;

const BROKEN: Fault = {
  message: "the computation ended in an unexpected way",
  help: "use the installed program: some analyses need threads or a clock, which this page does not have",
  findings: [],
};

/** Answers requests by a compiled program. */
export class Inside implements Transport {
  private program: Promise<Program>;

  constructor(private readonly code: WebAssembly.Module) {
    this.program = this.begun();
  }

  /** A program at its start; its files are those of the examples. */
  private async begun(): Promise<Program> {
    // Functions for browsers that crates bring along; nothing here calls them.
    const imports: WebAssembly.Imports = {};
    for (const { module, name } of WebAssembly.Module.imports(this.code)) {
      (imports[module] ??= {} as WebAssembly.ModuleImports)[name] = () => {
        throw new Error(`${name} is not available`);
      };
    }
    const program = (await WebAssembly.instantiate(this.code, imports)).exports as unknown as Program;
    // Models register themselves before anything is called.
    program.__wasm_call_ctors?.();
    return program;
  }

  private async call(request: Request): Promise<{ value: unknown } | { fault: Fault }> {
    const program = await this.program;
    try {
      const text = new TextEncoder().encode(JSON.stringify(request));
      const place = program.allocate(text.length);
      new Uint8Array(program.memory.buffer).set(text, place);
      const answer = program.answer(place);
      program.release(place);
      const length = new DataView(program.memory.buffer).getUint32(answer, true);
      const bytes = new Uint8Array(program.memory.buffer, answer + HEAD, length);
      const value = JSON.parse(new TextDecoder().decode(bytes));
      program.release(answer);
      return value;
    } catch (fault) {
      // A program that was stopped in the middle of its work cannot go on.
      console.error(fault);
      this.program = this.begun();
      return { fault: BROKEN };
    }
  }

  async ask<N extends keyof Answers>(request: Named<N>, signal?: AbortSignal): Promise<Answers[N]> {
    // The page draws first, and a newer request takes the place of this one.
    await new Promise((done) => setTimeout(done));
    signal?.throwIfAborted();
    const answer = await this.call(request as Request);
    if ("fault" in answer) throw new Refused(answer.fault);
    return answer.value as Answers[N];
  }

  async *stream<E>(request: Named<"run"> | Named<"watch">, signal?: AbortSignal): AsyncIterable<E> {
    if (request.request === "watch") {
      // Nobody else changes the files.
      while (!signal?.aborted) {
        yield { event: "alive" } as E;
        await new Promise((done) => setTimeout(done, 4000));
      }
      return;
    }
    await new Promise((done) => setTimeout(done, 50));
    signal?.throwIfAborted();
    const answer = await this.call(request);
    if ("fault" in answer) throw new Refused(answer.fault);
    for (const event of answer.value as { event: string; html?: string; address?: string }[]) {
      if (event.event === "report") event.address = URL.createObjectURL(new Blob([event.address ?? ""], { type: "text/html" }));
      yield event as E;
    }
  }
}

/** The program that a page contains: compressed, in digits of base 64. */
export async function compiled(text: string): Promise<WebAssembly.Module> {
  const bytes = Uint8Array.from(atob(text), (digit) => digit.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(stream).arrayBuffer());
}
