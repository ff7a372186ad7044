// Controls of the view: mouse, touch, keys, the slider over the mesh cycle, and what the colours mean.
const PERIOD = 2500;  // milliseconds that one base pitch takes

function shown(host, pair) {
  const find = (name) => host.querySelector(`.turning-${name}`), { head } = pair;
  const canvas = find("canvas"), slider = find("frame"), amount = find("scale"), run = find("run"), glass = find("glass");
  const gl = canvas.getContext("webgl2", { alpha: true, antialias: true, preserveDrawingBuffer: true });
  if (!gl) throw new Error("WebGL 2 is missing");
  const draw = drawing(gl, pair), first = head.stress ? { yaw: -0.45, pitch: 0.4 } : { yaw: -0.7, pitch: 0.6 };
  const view = { ...first, zoom: 1 };
  let waiting = false, running = false;

  slider.max = head.at.length - 1;
  slider.value = Math.floor(head.at.length / 2);
  [amount.max, amount.step, amount.value] = [5 * head.scale, head.scale / 10, head.scale];
  glass.checked = !head.stress;

  function ink() {
    const text = getComputedStyle(find("key")).color.match(/[\d.]+/g) || [213, 94, 0];
    return text.slice(0, 3).map((part) => part / 255);
  }
  function eye() {
    const [c, s, cp, sp] = [Math.cos(view.yaw), Math.sin(view.yaw), Math.cos(view.pitch), Math.sin(view.pitch)];
    return [c, -sp * s, cp * s, 0, cp, sp, -s, -sp * c, cp * c];  // by columns: to the right, up and towards the eye
  }
  function frameOf() { return Number(slider.value); }
  function redraw() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      const ratio = Math.min(window.devicePixelRatio || 1, 2), wide = canvas.clientWidth, high = canvas.clientHeight;
      [canvas.width, canvas.height] = [Math.max(1, Math.round(ratio * wide)), Math.max(1, Math.round(ratio * high))];
      const reach = head.reach / view.zoom, scale = Number(amount.value);
      draw({ frame: frameOf(), scale, eye: eye(), size: [reach, reach * canvas.height / canvas.width], glass: glass.checked, ink: ink() });
      find("place").textContent = `${head.at[frameOf()].toFixed(3)} base pitches from A`;
      find("times").textContent = `deflection × ${Number(scale.toPrecision(3))}`;
    });
  }
  function moved(frames) {
    slider.value = (frameOf() + frames + head.at.length) % head.at.length;
    redraw();
  }
  function toggle(to) {
    if (running === to) return;
    running = to;
    run.textContent = running ? "Stop" : "Play";
    run.setAttribute("aria-pressed", String(running));
    if (running) {
      let last = performance.now();
      const step = (now) => {
        if (!running || !canvas.isConnected || canvas.clientWidth === 0) { toggle(false); return; }
        if (now - last >= PERIOD / head.at.length) { last = now; moved(1); }
        requestAnimationFrame(step);
      };
      requestAnimationFrame(step);
    }
  }
  function turn(yaw, pitch) {
    view.yaw += yaw;
    view.pitch = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, view.pitch + pitch));
    redraw();
  }
  function zoom(factor) { view.zoom = Math.max(0.3, Math.min(20, view.zoom * factor)); redraw(); }
  function back() { Object.assign(view, first, { zoom: 1 }); redraw(); }

  const fingers = new Map();
  canvas.addEventListener("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); fingers.set(event.pointerId, [event.clientX, event.clientY]); });
  for (const ended of ["pointerup", "pointercancel"]) canvas.addEventListener(ended, (event) => fingers.delete(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    const old = fingers.get(event.pointerId), other = [...fingers].find(([id]) => id !== event.pointerId);
    if (!old) return;
    if (other) {
      const away = (p) => Math.hypot(p[0] - other[1][0], p[1] - other[1][1]);
      zoom((away([event.clientX, event.clientY]) || 1) / (away(old) || 1));
    } else turn((old[0] - event.clientX) / 150, (event.clientY - old[1]) / 150);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener("wheel", (event) => {  // the page scrolls unless the picture has been chosen
    if (document.activeElement !== canvas) return;
    event.preventDefault();
    zoom(Math.exp(-event.deltaY / 500));
  }, { passive: false });
  const keys = {
    ArrowLeft: () => turn(0.1, 0), ArrowRight: () => turn(-0.1, 0), ArrowUp: () => turn(0, -0.1), ArrowDown: () => turn(0, 0.1),
    "+": () => zoom(1.2), "=": () => zoom(1.2), "-": () => zoom(1 / 1.2), Home: back,
    PageUp: () => moved(1), PageDown: () => moved(-1), " ": () => toggle(!running),
  };
  canvas.addEventListener("keydown", (event) => {
    if (!(event.key in keys) || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key]();
  });
  slider.addEventListener("input", () => { toggle(false); redraw(); });
  amount.addEventListener("input", redraw);
  glass.addEventListener("change", redraw);
  run.addEventListener("click", () => toggle(!running));
  find("end").addEventListener("click", () => { Object.assign(view, { yaw: 0, pitch: 0 }); redraw(); });
  find("back").addEventListener("click", back);
  canvas.addEventListener("webglcontextlost", () => { toggle(false); failed(host, "the browser took the graphics memory away; load the page again"); });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  new ResizeObserver(redraw).observe(canvas);

  const bar = find("colours");
  bar.style.background = `linear-gradient(90deg, ${STOPS.map((stop) => `rgb(${stop})`).join(", ")})`;
  find("ticks").replaceChildren(...head.ticks.map((tick) => Object.assign(document.createElement("span"), { textContent: tick })));
  host.classList.add("turning-ready");
  redraw();
  toggle(!matchMedia("(prefers-reduced-motion: reduce)").matches);
}

function failed(host, why) {
  host.classList.remove("turning-ready");
  host.querySelector(".turning-missing").textContent = `The pair cannot be drawn here: ${why}. The pictures of this page and the files for ParaView show the same fields.`;
}

async function begin(host) {
  if (host.turning) return;
  host.turning = "begun";
  try {
    const head = JSON.parse(host.querySelector(".turning-head").textContent);
    host.turning = read(head, await unpacked(host.querySelector(".turning-numbers").textContent.trim()));
    shown(host, host.turning);
  } catch (fault) { failed(host, fault.message); }
}

for (const host of document.querySelectorAll(".turning")) {
  const folded = host.closest("details");
  if (!folded || folded.open) begin(host);
  else folded.addEventListener("toggle", () => begin(host), { once: true });
}
