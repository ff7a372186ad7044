// Curves over the mesh cycle and the teeth in mesh, as SVG: what the program sends, and nothing computed here but places.
window.flankfilmCharts = (() => {
  const WIDE = 420, TALL = 210, LEFT = 62, RIGHT = 10, TOP = 12, BOTTOM = 34;

  // Round numbers between two ends, five at most.
  const ticks = (low, high) => {
    const rough = (high - low) / 4 || 1, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((one) => one >= rough * (1 - 1e-9));
    const places = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) places.push(k * step);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    return places.map((value) => ({ value, text: value.toFixed(Math.min(decimals, 8)).replace("-0", "-0") }));
  };

  const chart = (position, curve, before) => {
    const lines = [...curve.lines, ...(before ? before.lines : [])];
    const values = lines.flat().filter((value) => value !== null);
    if (!values.length) return null;
    let low = Math.min(...values), high = Math.max(...values);
    const spare = 0.06 * (high - low) || Math.max(1e-9, 0.01 * Math.abs(high));
    low -= spare; high += spare;
    const x = (value) => LEFT + value * (WIDE - LEFT - RIGHT);
    const y = (value) => TOP + ((high - value) / (high - low)) * (TALL - TOP - BOTTOM);
    const path = (line, at) => {
      const places = Array.isArray(position[0]) ? position[at] : position;
      let drawn = "", pen = false;
      line.forEach((value, k) => {
        if (value === null) { pen = false; return; }
        drawn += `${pen ? "L" : "M"}${x(places[k]).toFixed(1)} ${y(value).toFixed(1)}`;
        pen = true;
      });
      return drawn;
    };
    return {
      wide: WIDE, tall: TALL, left: LEFT, right: WIDE - RIGHT, top: TOP, bottom: TALL - BOTTOM, x,
      paths: curve.lines.map(path), faint: before ? before.lines.map(path) : [],
      rows: ticks(low, high).map((tick) => ({ ...tick, y: y(tick.value) })),
      columns: ticks(0, 1).map((tick) => ({ ...tick, x: x(tick.value) })),
    };
  };

  // Curves of several runs, each over its positions; the axes are those of all.
  const overlay = (runs) => {
    const at = runs.flatMap((run) => run.lines.map(() => run.position));
    const whole = chart(at, { lines: runs.flatMap((run) => run.lines) }, null);
    if (!whole) return null;
    const paths = [...whole.paths];
    return { ...whole, runs: runs.map((run) => paths.splice(0, run.lines.length)) };
  };

  const outline = (points) => points.map((point) => point.join(",")).join(" ");

  // Both gears at a position of 0 to 1 base pitches after a pair of teeth is at A, and the contacts on the path.
  const mesh = (drawing, position) => {
    const [left, bottom, wide, tall] = drawing.box;
    const along = [drawing.end[0] - drawing.start[0], drawing.end[1] - drawing.start[1]];
    const length = Math.hypot(...along), contacts = [];
    for (let run = position * drawing.pitch; run <= length * (1 + 1e-9); run += drawing.pitch) {
      contacts.push([0, 1].map((k) => drawing.start[k] + (along[k] * run) / length));
    }
    const turned = (angle, centre) => `rotate(${(angle * position).toFixed(5)} ${centre[0]} ${centre[1]})`;
    return {
      box: `${left} ${-bottom - tall} ${wide} ${tall}`, unit: wide / 400, contacts,
      pinion: outline(drawing.pinion), wheel: outline(drawing.wheel),
      pinionTurn: turned(drawing.turn[0], [0, 0]), wheelTurn: turned(drawing.turn[1], drawing.centre),
      start: drawing.start, end: drawing.end,
    };
  };

  return { chart, mesh, overlay };
})();
