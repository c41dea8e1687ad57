/* What holds an object, tried live as rockfrag.assess.holding tries it: first so strong
 * that nothing breaks it, which says what it must bear, then as strong as that, or as
 * strong as somebody says, beside the object without it.
 *
 * Sizes that nobody stated are those of the core; bodies in a plane are shaken by the
 * contact kernels, those in space by that of bodies in space.
 */
const holding = (data, core, spatial) => {
  "use strict";
  const { UNBROKEN, PADS_AT, PLATE, RADIUS, SLIDES_AT, ROLLS_AT, LOCKED_AT } =
    data.constants;
  const { kinds, motions } = data.holding;

  // what holds a body in a plane, as the module of the contact kernels takes it
  const FASTENERS = { bracket: 1, cord: 2 };
  const fastened = (kind, bears, { statue }) =>
    core.within(() => {
      const found = core.zeros([4]);
      core.call("tell_fastener", spatial.rowOf(statue), kind === "bracket", found);
      const [tie_height, tie_reach, tie_stiffness, tie_damping] = found.values;
      const about = { tie_height, tie_reach, tie_stiffness, tie_damping };
      const is_bracket = kind === "bracket" ? 1 : 0;
      return { ...about, ties: FASTENERS[kind], is_bracket, tie_strength: bears };
    });
  const carriedOf = ({ statue, pedestal }) => (pedestal?.mass ?? 0) + statue.mass;
  const plateOf = (body) => PLATE * carriedOf(body);
  const sprung = (stroke, body) =>
    core.within(() => {
      const plate = plateOf(body);
      const found = core.zeros([3]);
      core.call("tell_springs", plate + carriedOf(body), found);
      const [spring_stiffness, spring_strength, spring_yield] = found.values;
      const springs = { spring_stiffness, spring_strength, spring_yield };
      return { plate, dish_friction: 0, stroke, ...springs };
    });
  const IN_PLANE = {
    putty: (bears, { statue: { width }, pedestal }) => ({
      bond_tension: bears,
      bond_shear: bears,
      bond_spread: core.call("pads_across", Math.min(width, pedestal?.width ?? width)),
    }),
    bracket: (bears, body) => fastened("bracket", bears, body),
    cord: (bears, body) => fastened("cord", bears, body),
    isolator: (bears, body) => ({
      plate: plateOf(body),
      dish_radius: RADIUS,
      dish_friction: SLIDES_AT,
      stroke: bears,
    }),
    springs: sprung,
    wall: (distance) => ({ wall: distance }),
    casters: (locked) => ({ friction: locked ? LOCKED_AT : ROLLS_AT }),
  };
  const IN_SPACE = {
    putty: (bears) => ({ bond: { tension: bears, shear: bears, padsAt: PADS_AT } }),
    wall: (distance) => ({ wall: distance }),
    casters: (locked) => ({ friction: locked ? LOCKED_AT : ROLLS_AT }),
  };

  // what holds it beside what it stands at, and what it stands at without that
  const unbroken = (kind) => kinds[kind].unbroken ?? Infinity;
  function holdersOf({ there, kind }, role, bears) {
    const known = there ? [there] : [];
    if (role === "free") return kind ? known : [];
    if (!kind) return known;
    if (kind === "off_wall") return [];
    if (kind === "locked") return [{ kind: "casters", value: true }];
    const value = role === "asked" ? unbroken(kind) : bears;
    return [...known, { kind, value }];
  }
  // whether a body in space is tried there: what takes long is tried in a plane
  const inSpace = ({ there, kind }, solid) => {
    if (!solid || kinds[kind]?.slow) return false;
    return !(solid.rim && there?.kind === "wall");
  };
  // runs of a trial, of the object as it stands and with what the sliders change
  function runsOf(hold, stands, changed) {
    const { times = 0, slow } = kinds[hold.kind] ?? {};
    const askedBy = slow ? "slow" : null;
    const chosenBy = (role) => (role === "asked" ? askedBy : "few");
    const run = (role, { body, solid }) => ({
      role,
      hold,
      body: { ...body, rolling: null },
      solid: inSpace(hold, solid) ? solid : null,
      chosen: chosenBy(role),
    });
    return [
      ...(times ? [run("asked", changed)] : []),
      run("free", stands),
      run("held", changed),
    ];
  }
  // places of the motions of a run; all if null
  const motionsOf = (request, { chosen }) =>
    chosen && motions[request.solid ? "space" : "plane"][chosen];
  const levelsOf = ({ solid, measure }) =>
    motions[solid ? "space" : "plane"].measures[measure];

  // a worker's part of a run, of motions at some places, as spatial.counter counts one,
  // and what each motion asks of what holds it; `shaken` gives a motion on the floor,
  // `scalesOf` levels and which are allowed, `factorsOf` the factors on what shakes
  function counter(ensemble, plane, space) {
    return function count(run, places, shaken, { scalesOf, factorsOf }) {
      const holders = holdersOf(run.hold, run.role, run.bears);
      const own = scalesOf(places);
      const make = run.solid ? inSpaceOf : inPlaneOf;
      const { countOf, lifting } = make(run, holders, { ensemble, plane, space });
      const found = countOf(places, shaken, { own, scalesOf, factorsOf });
      return {
        allowed: own.allowed,
        overturned: Uint8Array.from(found.fell),
        rocked: Uint8Array.from(found.rocked),
        leaning: Uint8Array.from(found.leans),
        // of what is held only simulation says
        lifting: Float64Array.from(places, (m) =>
          holders.length ? Infinity : lifting(m, shaken),
        ),
        demand: demandsOf(run, places, own.levels.length, found),
      };
    };
  }
  function demandsOf({ hold: { kind }, role }, places, each, found) {
    if (role !== "asked") return new Float64Array(places.length);
    const { times, demand } = kinds[kind];
    const asked = found[demand];
    return Float64Array.from(
      places,
      (_, i) => times * Math.max(...asked.subarray(i * each, (i + 1) * each)),
    );
  }
  function inPlaneOf({ body }, holders, { ensemble, plane }) {
    const free = ensemble.bodyOf(body);
    const given = holders.map(({ kind, value }) => IN_PLANE[kind](value, body));
    const held = { ...body, held: Object.assign({}, ...given) };
    // what only rolls or slides is one of pure rocking where it does neither
    const isLoose = holders.every(({ kind }) => kind === "casters");
    function countOf(places, shaken, { own, factorsOf }) {
      const shaking = places.map(shaken);
      const factors = factorsOf(own, shaking);
      const pure = () => {
        const { overturned, rocked } = ensemble.count(free, shaking, factors);
        return { fell: overturned, rocked, leans: new Uint8Array(rocked.length) };
      };
      if (!holders.length) return pure();
      const found = plane.count(plane.bodyOf(held), shaking, factors);
      if (!isLoose) return found;
      const other = pure();
      const either = (name) =>
        found[name].map((value, k) => (found.loose[k] ? value : other[name][k]));
      return {
        fell: either("fell"),
        rocked: either("rocked"),
        leans: either("leans"),
      };
    }
    const lifting = (m, shaken) =>
      core.call("lifting_in_plane", free.uplift, shaken(m).peak);
    return { countOf, lifting };
  }
  function inSpaceOf({ solid }, holders, { space }) {
    const given = holders.map(({ kind, value }) => IN_SPACE[kind](value));
    const body = space.bodyOf({ ...solid, ...Object.assign({}, ...given) });
    const pairOf = (m, shaken) => spatial.pairOf(spatial.recordOf[m], shaken);
    function countOf(places, shaken, { own: { levels }, scalesOf, factorsOf }) {
      const each = levels.length;
      const [fell, rocked, leans, force] = [0, 1, 2, 3].map(
        () => new Float64Array(places.length * each),
      );
      places.forEach((m, i) => {
        const { first } = spatial.recordOf[m];
        const before = places.findIndex((p) => spatial.recordOf[p].first === first);
        if (before < i) {
          // the record's other component, which was with it
          for (const table of [fell, rocked, leans, force])
            table.copyWithin(i * each, before * each, (before + 1) * each);
          return;
        }
        const [one, other] = pairOf(m, shaken);
        const factors = factorsOf(scalesOf([first]), [shaken(first)]);
        factors.forEach((scale, k) => {
          const out = space.integrate({
            body,
            x: one.samples,
            y: other?.samples ?? null,
            dt: one.dt,
            scale,
          });
          fell[i * each + k] = out.overturned ? 1 : 0;
          rocked[i * each + k] = out.peak > 0 ? 1 : 0;
          leans[i * each + k] = out.leans ? 1 : 0;
          force[i * each + k] = out.force * solid.mass;
        });
      });
      return { fell, rocked, leans, force };
    }
    const lifting = (m, shaken) => spatial.liftingInSpace(body, pairOf(m, shaken));
    return { countOf, lifting };
  }
  return { runsOf, motionsOf, levelsOf, counter, kinds };
};
if (typeof module !== "undefined") module.exports = holding;
