// Calls of the core in a worker: one at a time, the newest of each key, and all can be cancelled.

/** An answer that nobody waits for any more. */
export class Outdated extends Error {}

export class Jobs {
  /** `script` is the worker's text, `module` the compiled core; `busy` is told which share of what was asked is done, null when nothing is. */
  constructor(script, module, busy) {
    this.url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    this.module = module;
    this.busy = busy;
    this.waiting = [];
    this.running = null;
    this.count = 0;
    /** Jobs since it was idle. */
    this.begun = 0;
    this.start();
  }

  start() {
    this.worker = new Worker(this.url);
    this.worker.postMessage({ module: this.module });
    this.worker.addEventListener("message", ({ data: { id, answer, error } }) => {
      const job = this.running;
      if (!job || job.id !== id) return;
      this.running = null;
      if (error) job.reject(Object.assign(new Error(error.message), error));
      else job.resolve(answer);
      this.next();
    });
    this.worker.addEventListener("error", (event) => {
      // A core that ran out of memory cannot go on: the next call has a new one.
      event.preventDefault();
      const job = this.running;
      this.restart();
      job?.reject(new Error(event.message || "the worker stopped"));
      this.next();
    });
  }

  restart() {
    this.worker.terminate();
    this.running = null;
    this.start();
  }

  /** The answer of a call; a later one of the same key takes the place of one that waits or runs. */
  ask(key, name, given) {
    this.drop(key);
    this.begun++;
    return new Promise((resolve, reject) => {
      this.waiting.push({ id: ++this.count, key, name, given, resolve, reject });
      this.next();
    });
  }

  /** Forget what is asked under a key; what runs is stopped. */
  drop(key) {
    this.waiting = this.waiting.filter((job) => job.key !== key || job.reject(new Outdated()));
    if (this.running?.key === key) {
      const job = this.running;
      this.restart();
      job.reject(new Outdated());
      this.next();
    }
  }

  /** Stop everything. */
  cancel() {
    const jobs = [...this.waiting, ...(this.running ? [this.running] : [])];
    this.waiting = [];
    if (this.running) this.restart();
    for (const job of jobs) job.reject(new Outdated());
    this.begun = 0;
    this.busy(null);
  }

  next() {
    if (!this.running && this.waiting.length) {
      this.running = this.waiting.shift();
      const { id, name, given } = this.running;
      this.worker.postMessage({ id, name, given });
    }
    if (!this.running) this.begun = 0;
    this.busy(this.running && (this.begun - this.waiting.length - 1) / this.begun);
  }
}
