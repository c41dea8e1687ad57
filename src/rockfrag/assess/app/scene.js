/* The object rocking in space under the record that decides: its history by the module,
 * its view by view.js.
 */
const sceneInSpace = (data, canvas, redraw) => {
  "use strict";
  const view = rockfragView(canvas, redraw);
  let space = null;
  let spatial = null;
  let building = null;
  // the response under a record on a floor; `motionOf` gives a motion, `bytes` the
  // module
  async function respond(
    { statue, pedestal, solid, measure, place },
    { motion, level },
    motionOf,
    bytes,
  ) {
    space ??= await rockfragSpace(await bytes("space"));
    if (!spatial) {
      const core = await rockfragCore(await bytes("core"));
      spatial = inSpace(data, core);
      building = floors(data, core);
    }
    const record = spatial.recordOf[motion];
    const shaken = new Map();
    for (const m of [record.first, record.second]) {
      if (m === null) continue;
      const ground = await motionOf(m);
      shaken.set(
        m,
        place.ground ? ground : building.floorMotion(place.floors[""], ground),
      );
    }
    const [one, other] = spatial.pairOf(record, (m) => shaken.get(m));
    const body = space.bodyOf(spatial.solidOf(statue, statue, solid));
    const scale = level / data.both.measures[measure].values[record.first];
    const response = space.integrate({
      body,
      x: one.samples,
      y: other?.samples ?? null,
      dt: one.dt,
      scale,
      history: true,
    });
    const tilt = (k) =>
      Math.hypot(
        response.history[k * space.columns + 4],
        response.history[k * space.columns + 5],
      );
    let most = 0;
    for (let k = 0; k < response.done; k++) if (tilt(k) > tilt(most)) most = k;
    return {
      ...response,
      dt: one.dt,
      most,
      columns: space.columns,
      fallen: response.overturned ? 1 : 0,
      body,
      statue,
      pedestal,
      round: solid.round,
    };
  }
  // a moment of a response, on this canvas or another one
  function paint(
    context,
    { history, columns, body, statue, pedestal, round },
    k,
    colour,
  ) {
    const row = history.subarray(k * columns, (k + 1) * columns);
    const { width, height } = context.canvas;
    const colours = Object.fromEntries(
      ["line", "rule", "ink", "accent", "blue"].map((name) => [name, colour(name)]),
    );
    context.clearRect(0, 0, width, height);
    view.paint(
      context,
      width,
      height,
      {
        points: body.points,
        tall: statue.height,
        over: body.height,
        round,
        place: row.subarray(0, 3),
        attitude: row.subarray(3, 7),
        pedestal,
      },
      colours,
    );
  }
  return { respond, paint };
};
