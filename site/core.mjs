// The core in WebAssembly: calls by name, with what they take and answer as plain objects.
//
//     const core = await load("core.wasm");
//     core.call("balance", { engine: text, rpm: 6000 }).total.force.peak;
//
// In pages, in workers and in Node; rust/web/README.md lists the calls. Columns of numbers are Float64Arrays.

/** An input that makes no engine, or a call that cannot be met; in the words of the library. */
export class InputError extends Error {
  constructor({ message, argument, value, hint }) {
    super(message);
    this.name = "InputError";
    Object.assign(this, { argument, value, hint });
  }
}

/** The core from the address of its module, its bytes, or a response that has them. */
export async function load(source) {
  const bytes = await bytesOf(source);
  return new Core(await WebAssembly.compile(bytes));
}

/**
 * @param {ArrayBuffer | Uint8Array<ArrayBuffer> | Response | string} source
 * @returns {Promise<BufferSource>}
 */
async function bytesOf(source) {
  if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return source;
  const response = source instanceof Response ? source : await fetch(source);
  if (!response.ok) throw new Error(`${response.url}: ${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}

export class Core {
  #module;
  #instance = null;

  constructor(module) {
    this.#module = module;
  }

  /** Answer of a call; an InputError if it has none. */
  call(name, given = {}) {
    const numbers = [];
    const text = JSON.stringify({ call: name, with: given }, (_, value) => pointed(value, numbers));
    const { result, error } = this.#answer(new TextEncoder().encode(text), numbers);
    if (error) throw new InputError(error);
    return result;
  }

  /** Bytes of memory that the module has. */
  get memory() {
    return this.#instance ? this.#instance.memory.buffer.byteLength : 0;
  }

  #answer(request, given) {
    this.#instance ??= new WebAssembly.Instance(this.#module).exports;
    const core = this.#instance;
    try {
      const to = core.request(request.length);
      new Uint8Array(core.memory.buffer, to, request.length).set(request);
      const total = given.reduce((sum, each) => sum + each.length, 0);
      // Where the memory grows for them, its buffer is a new one.
      const at = core.given(total);
      const numbersTo = new Float64Array(core.memory.buffer, at, total);
      given.reduce((start, each) => (numbersTo.set(each, start), start + each.length), 0);
      core.compute();
      const text = new Uint8Array(core.memory.buffer, core.text(), core.text_bytes());
      const numbers = new Float64Array(core.memory.buffer, core.numbers(), core.numbers_count()).slice();
      return JSON.parse(new TextDecoder().decode(text), (_, value) => columned(value, numbers));
    } catch (trapped) {
      // What is left of an instance that trapped is not to be trusted: the next call has a new one.
      this.#instance = null;
      if (!(trapped instanceof WebAssembly.RuntimeError) && !(trapped instanceof RangeError)) throw trapped;
      const hint = "ask for less at once; if that does not help, please report the call";
      throw new InputError({ message: `the core stopped (${trapped.message}): ${hint}`, argument: null, value: null, hint });
    }
  }
}

/**
 * A typed array goes beside the text, unchanged.
 *
 * @param {any} value
 * @param {any[]} numbers
 */
function pointed(value, numbers) {
  if (!ArrayBuffer.isView(value)) return value;
  const start = numbers.reduce((sum, each) => sum + each.length, 0);
  numbers.push(value);
  return { column: [start, numbers.at(-1).length] };
}

function columned(value, numbers) {
  if (!Array.isArray(value?.column)) return value;
  const [start, count] = value.column;
  return numbers.subarray(start, start + count);
}
