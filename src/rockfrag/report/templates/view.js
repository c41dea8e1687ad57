/* A body in perspective on its ground, drawn on a canvas by plain script; mouse, finger
 * and keys turn the view.
 */
function rockfragView(canvas, redraw) {
  "use strict";
  const START = { azimuth: -1.05, elevation: 0.3, zoom: 1 };
  const view = { ...START };
  const times = (s, a) => a.map((value) => s * value);
  const plus = (a, b) => a.map((value, i) => value + b[i]);
  const minus = (a, b) => a.map((value, i) => value - b[i]);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
  ];
  const unit = (a) => times(1 / Math.max(Math.hypot(...a), 1e-300), a);
  const within = (low, high, value) => Math.max(low, Math.min(high, value));

  // ---- who looks

  const KEYS = {
    ArrowLeft: () => turn(-0.12, 0),
    ArrowRight: () => turn(0.12, 0),
    ArrowUp: () => turn(0, 0.08),
    ArrowDown: () => turn(0, -0.08),
    "+": () => enlarge(1.15),
    "=": () => enlarge(1.15),
    "-": () => enlarge(1 / 1.15),
    0: () => {
      Object.assign(view, START);
      redraw();
    },
  };
  function turn(around, up) {
    view.azimuth -= around;
    view.elevation = within(0.03, 1.5, view.elevation + up);
    redraw();
  }
  function enlarge(factor) {
    view.zoom = within(0.5, 3, view.zoom * factor);
    redraw();
  }
  let held = null;
  canvas.addEventListener("pointerdown", (event) => {
    held = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!held) return;
    const [x, y] = held;
    held = [event.clientX, event.clientY];
    turn((event.clientX - x) / 130, (event.clientY - y) / 180);
  });
  for (const end of ["pointerup", "pointercancel"])
    canvas.addEventListener(end, () => {
      held = null;
    });
  canvas.addEventListener("keydown", (event) => {
    if (!KEYS[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    KEYS[event.key]();
    event.preventDefault();
  });

  // where a camera that looks at the middle of something so tall shows a place
  function camera(width, height, tall, broad) {
    const size = Math.max(tall, broad);
    const away = 3.4 * size;
    const target = [0, 0, 0.45 * tall];
    const back = [
      Math.cos(view.elevation) * Math.cos(view.azimuth),
      Math.cos(view.elevation) * Math.sin(view.azimuth),
      Math.sin(view.elevation),
    ];
    const eye = plus(target, times(away, back));
    const right = unit(cross(times(-1, back), [0, 0, 1]));
    const up = cross(back, right);
    const focus = (view.zoom * 0.66 * Math.min(height, width) * away) / size;
    return {
      eye,
      show: (p) => {
        const d = minus(p, eye);
        const depth = -dot(d, back);
        return [
          width / 2 + (focus * dot(d, right)) / depth,
          0.52 * height - (focus * dot(d, up)) / depth,
        ];
      },
    };
  }

  // ---- what is seen

  // a prism over a polygon from below to above, at a place and attitude (a quaternion)
  function prism(points, low, high, place = [0, 0, 0], [w, x, y, z] = [1, 0, 0, 0]) {
    const rows = [
      [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
      [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
      [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ];
    const at = (level) =>
      points.map((p) =>
        plus(
          place,
          rows.map((row) => dot(row, [...p, level])),
        ),
      );
    const bottom = at(low);
    const top = at(high);
    const n = points.length;
    return [
      [...bottom].reverse(),
      top,
      ...points.map((_, i) => [
        bottom[i],
        bottom[(i + 1) % n],
        top[(i + 1) % n],
        top[i],
      ]),
    ];
  }
  const LIGHT = unit([-0.4, -0.8, 1.1]);

  // faces of a convex solid that face the eye hide nothing of each other
  function solid(context, { eye, show }, { faces, colour, ink, smooth }) {
    for (const face of faces) {
      const normal = unit(cross(minus(face[1], face[0]), minus(face[2], face[0])));
      if (dot(normal, minus(eye, face[0])) <= 0) continue;
      path(context, face.map(show));
      context.fillStyle = colour;
      context.fill();
      const side = smooth && face.length === 4;
      context.strokeStyle = side ? colour : ink;
      if (side) context.stroke();
      const light = dot(normal, LIGHT);
      context.fillStyle =
        light > 0
          ? `rgba(255,255,255,${0.38 * light})`
          : `rgba(0,0,0,${-0.45 * light})`;
      context.fill();
      if (!side) context.stroke();
    }
  }
  function path(context, places) {
    context.beginPath();
    for (const [x, y] of places) context.lineTo(x, y);
    context.closePath();
  }
  function grid(context, show, { step, reach, about: [x, y], colour }) {
    context.strokeStyle = colour;
    context.beginPath();
    const line = (a, b) => {
      context.moveTo(...show(a));
      context.lineTo(...show(b));
    };
    const count = Math.floor(reach / step);
    for (let k = -count; k <= count; k++) {
      line([x + k * step, y - reach, 0], [x + k * step, y + reach, 0]);
      line([x - reach, y + k * step, 0], [x + reach, y + k * step, 0]);
    }
    context.stroke();
  }

  // a body by the plan of its base, its height, and where its centre of gravity is over
  // the base; the ground's place
  function paint(
    context,
    width,
    height,
    {
      points,
      tall,
      over,
      round = false,
      place,
      attitude,
      ground = [0, 0],
      pedestal = null,
      trace = [],
    },
    colours,
  ) {
    const below = pedestal?.height ?? 0;
    const broad =
      2 * Math.max(...points.map((p) => Math.hypot(...p)), (pedestal?.width ?? 0) / 2);
    const look = camera(width, height, below + tall, 1.2 * broad);
    const step =
      [0.1, 0.2, 0.5, 1, 2, 5].find((one) => one > 0.14 * (below + tall)) ?? 10;
    const reach = 1.35 * Math.max(below + tall, broad);
    grid(context, look.show, { step, reach, about: ground, colour: colours.line });
    const lifted = (p) => [p[0] + ground[0], p[1] + ground[1], p[2] + below];
    if (pedestal) {
      const half = pedestal.width / 2;
      const deep = (pedestal.depth ?? pedestal.width) / 2;
      const plan = pedestal.round
        ? ring(half)
        : [
            [-half, -deep],
            [half, -deep],
            [half, deep],
            [-half, deep],
          ];
      solid(context, look, {
        faces: prism(plan, 0, below, [...ground, 0]),
        colour: colours.rule,
        ink: colours.ink,
        smooth: pedestal.round,
      });
    }
    // where it stood, and the way of the middle of its base
    context.strokeStyle = colours.accent;
    path(
      context,
      points.map((p) => look.show(lifted([...p, 0]))),
    );
    context.stroke();
    context.beginPath();
    for (const p of trace) context.lineTo(...look.show(lifted([...p, 0])));
    context.stroke();
    solid(context, look, {
      faces: prism(points, -over, tall - over, lifted(place), attitude),
      colour: colours.blue,
      ink: colours.ink,
      smooth: round,
    });
    return step;
  }
  const ring = (radius) =>
    Array.from({ length: 32 }, (_, i) => [
      radius * Math.cos((i * Math.PI) / 16),
      radius * Math.sin((i * Math.PI) / 16),
    ]);
  return { paint, view, turn };
}
