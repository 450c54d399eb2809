// Plays: tells of the time that passes between frames, only while the page can be seen.

/** With reduced motion the picture changes no more often than this, milliseconds. */
const CALM = 500;

/** Longer gaps between frames count as this, milliseconds. */
const LONGEST = 100;

export class Player {
  /** `advance` is told of the seconds that passed; `element` must be on the screen to play. */
  constructor(element, advance) {
    this.advance = advance;
    this.playing = false;
    this.onScreen = true;
    this.request = null;
    this.calm = matchMedia("(prefers-reduced-motion: reduce)");
    this.waited = 0;
    this.resume = () => this.wake();
    document.addEventListener("visibilitychange", this.resume);
    this.observer = new IntersectionObserver((entries) => {
      this.onScreen = entries[entries.length - 1].isIntersecting;
      this.wake();
    });
    this.observer.observe(element);
  }

  set(playing) {
    this.playing = playing;
    this.wake();
  }

  /** Ask for frames while it plays and can be seen, else for none. */
  wake() {
    const wanted = this.playing && this.onScreen && !document.hidden;
    if (wanted && this.request === null) {
      this.last = null;
      this.request = requestAnimationFrame((now) => this.frame(now));
    } else if (!wanted && this.request !== null) {
      cancelAnimationFrame(this.request);
      this.request = null;
    }
  }

  frame(now) {
    this.request = requestAnimationFrame((next) => this.frame(next));
    if (this.last !== null) this.waited += Math.min(now - this.last, LONGEST);
    this.last = now;
    if (this.waited > 0 && (!this.calm.matches || this.waited >= CALM)) {
      const seconds = this.waited / 1e3;
      this.waited = 0;
      this.advance(seconds);
    }
  }

  destroy() {
    this.set(false);
    document.removeEventListener("visibilitychange", this.resume);
    this.observer.disconnect();
  }
}
