// Parallel projections of the engine, and outlines of what is drawn in them.

/** @type {(a: number[], b: number[]) => number} */
const cross = ([a, b], [c, d]) => a * d - b * c;
/** @type {(a: number[], b: number[]) => number[]} */
const product = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
const unitVector = (vector) => {
  const length = Math.hypot(...vector);
  return vector.map((part) => part / length);
};

/** Directions, in x, y, z, towards the reader and of the picture's right and up. */
function seen(from, top) {
  const toward = unitVector(from);
  const right = unitVector(product(top, toward));
  return { toward, right, up: product(toward, right) };
}

const FRAMES = {
  cross: seen([0, 0, 1], [0, 1, 0]),
  left: seen([-1, 0, 0], [0, 1, 0]),
  right: seen([1, 0, 0], [0, 1, 0]),
  above: seen([0, 1, 0], [1, 0, 0]),
  isometric: seen([1, 1, 1], [0, 1, 0]),
  oblique: seen([0.22, 0.55, 0.8], [0, 1, 0]),
};

/** The convex outline of points. */
export function hull(points) {
  const sorted = [...points].sort(([a, b], [c, d]) => a - c || b - d);
  const chain = (along) => {
    const kept = [];
    for (const [x, y] of along) {
      const turns = () => {
        const [[a, b], [c, d]] = kept.slice(-2);
        return cross([c - a, d - b], [x - a, y - b]) > 0;
      };
      while (kept.length > 1 && !turns()) kept.pop();
      kept.push([x, y]);
    }
    return kept.slice(0, -1);
  };
  return [...chain(sorted), ...chain(sorted.reverse())];
}

/** A projection: metres to pixels of a picture, y downwards. */
export class Projection {
  toward;
  right;
  up;

  constructor(name) {
    Object.assign(this, FRAMES[name]);
    this.name = name;
    this.scale = 1;
    this.origin = [0, 0];
    this.stretch = 1;
  }

  /**
   * Fit points into a picture; z is stretched for engines whose cylinders stand close together.
   *
   * @param {number[][]} points
   * @param {number[]} size
   * @param {number[]} margins
   */
  fit(points, [width, height], [aside, above], stretch) {
    Object.assign(this, { scale: 1, origin: [0, 0], stretch });
    const seen = points.map((point) => this.point(point));
    const [xs, ys] = [0, 1].map((k) => seen.map((point) => point[k]));
    const [left, right, top, bottom] =
      [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    this.scale = Math.min(
      (width - 2 * aside) / (right - left || 1),
      (height - 2 * above) / (bottom - top || 1),
    );
    this.origin = [
      width / 2 - (this.scale * (left + right)) / 2,
      height / 2 - (this.scale * (top + bottom)) / 2,
    ];
  }

  /** A place in metres as pixels. */
  point(place) {
    const [x, y] = this.vector(place);
    return [this.origin[0] + x, this.origin[1] + y];
  }

  /**
   * A displacement in metres as pixels.
   *
   * @param {number[]} displacement
   */
  vector([x, y, z]) {
    const { right, up, scale } = this;
    const along = z * this.stretch;
    return [
      scale * (right[0] * x + right[1] * y + right[2] * along),
      -scale * (up[0] * x + up[1] * y + up[2] * along),
    ];
  }

  /**
   * Places with larger depths are nearer to the reader.
   *
   * @param {number[]} place
   */
  depth([x, y, z]) {
    return this.toward[0] * x + this.toward[1] * y + this.toward[2] * z * this.stretch;
  }

  /** The part of a rotation, about x, y and z, that is seen turning, counter-clockwise. */
  about(turn) {
    return turn[0] * this.toward[0] + turn[1] * this.toward[1] + turn[2] * this.toward[2];
  }

  /** The displacement in metres, within the picture, that moves a point by pixels: of views along an axis. */
  moved([x, y]) {
    const { right, up, scale, stretch } = this;
    const [a, b, c] = [0, 1, 2].map((k) => (right[k] * x - up[k] * y) / scale);
    return [a, b, c / stretch];
  }

  /** Outline of a cylinder about an axis in the cross-section, from one place of it to another. */
  tube([dx, dy], from, to, radius) {
    const ellipse = this.ellipse([dx, dy], radius);
    const axis = this.vector([dx, dy, 0]);
    // The outline leaves each end where that is parallel to the axis.
    const start = Math.atan2(cross(ellipse.v, axis), cross(ellipse.u, axis));
    const [nx, ny] = ellipse.at(start + Math.PI / 2);
    const outward = nx * axis[0] + ny * axis[1] >= 0;
    const shifted = (places, by) => places.map(([x, y]) => [x + by * axis[0], y + by * axis[1]]);
    const half = (begin) => ellipse.arc(begin, begin + Math.PI);
    const [far, near] = outward ? [to, from] : [from, to];
    return [...shifted(half(start), far), ...shifted(half(start + Math.PI), near)];
  }

  /** A circle across an axis in the cross-section, about that axis: points by an angle. */
  ellipse([dx, dy], radius) {
    const u = this.vector([-dy * radius, dx * radius, 0]);
    const v = this.vector([0, 0, radius / this.stretch]);
    const at = (phi) => {
      const [cos, sin] = [Math.cos(phi), Math.sin(phi)];
      return [u[0] * cos + v[0] * sin, u[1] * cos + v[1] * sin];
    };
    const arc = (from, to, steps = 14) =>
      Array.from({ length: steps + 1 }, (_, k) => at(from + ((to - from) * k) / steps));
    return { u, v, at, arc };
  }
}
