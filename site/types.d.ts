// What subclasses add to classes of the turning page, for the check of types alone.

import "../python/crankpin/view/web/turning.mjs";
import "../python/crankpin/view/web/view.mjs";

declare module "../python/crankpin/view/web/turning.mjs" {
  interface Turning {
    element: any;
    scenes: any[];
    build(title: string): void;
    check(changes: any): void;
    configure(looksTheSame?: boolean): void;
    follow(changed: string[]): void;
    pose(): void;
  }
}

declare module "../python/crankpin/view/web/view.mjs" {
  interface View {
    changed(keys: string[]): void;
    draw(pose: any, strokes: any): void;
    layout(orders: any): void;
  }
}
