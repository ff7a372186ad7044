// The page of flankfilm app: what it shows is the program's answer to each call; it computes nothing of gears.
(() => {
  const TEMPLATE = `
<div class="ff">
  <header class="ff-bar">
    <strong>flankfilm</strong>
    <span class="ff-name" :title="folder">{{ view.name || "not saved" }}{{ view.saved ? "" : " *" }}</span>
    <span class="ff-space"></span>
    <v-btn size="small" variant="tonal" @click="dialog = 'open'">Open</v-btn>
    <v-btn size="small" variant="tonal" @click="startSaving">Save</v-btn>
    <v-btn size="small" variant="tonal" @click="call('undo')">Undo</v-btn>
    <v-btn size="small" variant="tonal" @click="show('python')">Python</v-btn>
    <v-btn size="small" variant="tonal" @click="show('text')">File</v-btn>
    <v-btn size="small" variant="tonal" @click="list('listed', 'results')">Results</v-btn>
    <v-btn size="small" variant="tonal" @click="list('studies', 'studies')">Studies</v-btn>
    <v-btn size="small" color="primary" :disabled="faulty || running" @click="startRun">Run</v-btn>
  </header>
  <v-alert v-if="problem" type="error" density="compact" closable role="alert" @click:close="problem = ''">
    {{ problem }}</v-alert>
  <section v-if="run" class="ff-run" aria-label="Run">
    <div class="ff-row"><b>{{ runTitle }}</b><span>{{ (run.seconds + waited).toFixed(0) }} s</span><span v-if="timeLeft">{{ timeLeft }}</span>
      <v-btn v-if="running" size="small" variant="outlined" @click="call('cancel')">Cancel</v-btn>
      <a v-if="run.report && !running" :href="report" target="_blank" rel="noopener">Open the report</a></div>
    <v-progress-linear :model-value="100 * run.done / run.total" :indeterminate="running && !run.done"
      height="8" color="primary" :aria-label="run.what"></v-progress-linear>
    <details :open="run.status !== null && run.status !== 0"><summary>Log</summary><pre tabindex="0">{{ run.log.join("\\n") }}</pre></details>
    <flankfilm-rows v-if="table" :table="table" :unit="unit"></flankfilm-rows>
  </section>
  <div class="ff-body">
    <nav class="ff-form" aria-label="Scene">
      <p v-for="text in view.faults[''] || []" class="ff-fault" role="alert">{{ text }}</p>
      <v-expansion-panels multiple variant="accordion" v-model="opened">
        <v-expansion-panel v-for="section in sections" :key="section.path" :value="section.path">
          <v-expansion-panel-title :class="'ff-depth' + section.depth">
            <span><b>{{ section.path || "scene" }}</b>
              <span v-if="section.faults" class="ff-count" :title="section.faults + ' faults'">! {{ section.faults }}</span>
              <small>{{ section.meaning }}</small></span>
          </v-expansion-panel-title>
          <v-expansion-panel-text>
            <p v-for="text in view.faults[section.path] || []" class="ff-fault" role="alert">{{ text }}</p>
            <div v-for="key in section.keys" :key="key.path" class="ff-key" :title="key.meaning + (key.allowed ? ': ' + key.allowed : '')">
              <v-select v-if="key.kind === 'words'" :label="key.name" :items="key.choices" multiple chips closable-chips
                :model-value="words(key)" @update:model-value="edit(key.path, JSON.stringify($event))"
                density="compact" :hint="key.meaning" :error-messages="view.faults[key.path] || []"></v-select>
              <v-select v-else-if="key.kind === 'choice' || key.kind === 'switch'" :label="key.name" :items="key.choices"
                :model-value="view.values[key.path] || null" clearable :placeholder="plain(key.default)" persistent-placeholder
                @update:model-value="edit(key.path, $event || '')"
                density="compact" :hint="key.meaning" :error-messages="view.faults[key.path] || []"></v-select>
              <v-text-field v-else :label="key.name" :suffix="unit(key.unit)" :placeholder="plain(key.default)" persistent-placeholder
                :model-value="shown(key.path)" @update:model-value="edit(key.path, $event || '')"
                @focus="typing = key.path" @blur="typing = ''" :hint="key.meaning" spellcheck="false"
                density="compact" :error-messages="view.faults[key.path] || []"></v-text-field>
            </div>
          </v-expansion-panel-text>
        </v-expansion-panel>
      </v-expansion-panels>
    </nav>
    <main class="ff-main">
      <section class="ff-sliders" aria-label="Drag">
        <label v-for="one in view.sliders" :key="one.path" :class="{ 'ff-bad': view.faults[one.path] }">
          <span>{{ one.label }} <output>{{ view.values[one.path] || dragged(one) }} {{ unit(one.unit) }}</output></span>
          <input type="range" :min="one.low" :max="one.high" :step="one.step" :value="dragged(one)"
            @input="drag(one.path, $event.target.value)" :aria-label="one.label">
          <small v-if="view.faults[one.path]" class="ff-fault">{{ view.faults[one.path][0] }}</small>
        </label>
      </section>
      <p class="ff-state" role="status" aria-live="polite">{{ status }}</p>
      <section class="ff-curves" aria-label="Teeth in mesh, and curves over the mesh cycle">
        <div v-if="teeth" class="ff-mesh">
          <svg :viewBox="teeth.box" role="img" aria-label="Teeth in mesh at the chosen position">
            <g transform="scale(1 -1)">
              <polygon class="ff-pinion" :points="teeth.pinion" :transform="teeth.pinionTurn" :stroke-width="teeth.unit"></polygon>
              <polygon class="ff-wheel" :points="teeth.wheel" :transform="teeth.wheelTurn" :stroke-width="teeth.unit"></polygon>
              <line class="ff-path" :x1="teeth.start[0]" :y1="teeth.start[1]" :x2="teeth.end[0]" :y2="teeth.end[1]" :stroke-width="teeth.unit"></line>
              <circle v-for="at in teeth.contacts" class="ff-contact" :cx="at[0]" :cy="at[1]" :r="3.2 * teeth.unit"></circle>
            </g>
          </svg>
          <label><span>position, base pitches from A <output>{{ position.toFixed(2) }}</output></span>
            <input type="range" min="0" max="0.99" step="0.01" v-model.number="position" aria-label="position"></label>
        </div>
        <figure v-for="curve in curves" :key="curve.name">
          <figcaption><b>{{ curve.label }}</b>{{ curve.unit ? " [" + unit(curve.unit) + "]" : "" }} <small>{{ curve.error }}</small>
            <small v-for="(name, k) in curve.of || []" class="ff-legend"><svg viewBox="0 0 40 10" aria-hidden="true"><path :class="'ff-line ff-line' + k" d="M0 5H40"></path></svg> {{ name }} </small></figcaption>
          <svg v-if="curve.chart" :viewBox="'0 0 ' + curve.chart.wide + ' ' + curve.chart.tall" role="img" :aria-label="curve.label">
            <g v-for="row in curve.chart.rows"><line class="ff-grid" :x1="curve.chart.left" :x2="curve.chart.right" :y1="row.y" :y2="row.y"></line>
              <text text-anchor="end" :x="curve.chart.left - 6" :y="row.y + 4">{{ row.text }}</text></g>
            <g v-for="column in curve.chart.columns"><text text-anchor="middle" :x="column.x" :y="curve.chart.bottom + 16">{{ column.text }}</text></g>
            <text text-anchor="end" :x="curve.chart.right" :y="curve.chart.tall - 3">position [base pitches]</text>
            <path v-for="line in curve.chart.faint" class="ff-faint" :d="line"></path>
            <path v-for="(line, k) in curve.chart.paths" :class="'ff-line ff-line' + k % 4" :d="line"></path>
            <line class="ff-here" :x1="curve.chart.x(position)" :x2="curve.chart.x(position)" :y1="curve.chart.top" :y2="curve.chart.bottom"></line>
          </svg>
        </figure>
      </section>
      <details v-for="group in groups" :key="group.name" class="ff-answers" :open="group.name !== 'Inspection'">
        <summary>{{ group.name }}</summary>
        <div v-for="one in group.answers" class="ff-answer"><span>{{ one.name }}</span>
          <span class="ff-value">{{ one.text }} {{ unit(one.unit) }} <s v-if="one.was">{{ one.was }}</s></span>
          <small>{{ one.error }}</small></div>
      </details>
      <ul v-if="(view.heard || []).length" class="ff-heard"><li v-for="text in view.heard">{{ text }}</li></ul>
    </main>
  </div>
  <v-dialog :model-value="!!dialog" @update:model-value="dialog = ''" :max-width="['results', 'studies'].includes(dialog) ? 1100 : 760" scrollable>
    <v-card v-if="dialog === 'open'" title="Open">
      <v-card-text class="ff-list"><p>Files in {{ folder }}</p>
        <v-btn v-for="file in files" :key="file" variant="text" @click="open('open', file)">{{ file }}</v-btn>
        <p>Examples</p><v-btn variant="text" @click="open('example', '')">template</v-btn>
        <v-btn v-for="name in examples" :key="name" variant="text" @click="open('example', name)">{{ name }}</v-btn></v-card-text>
    </v-card>
    <v-card v-else-if="dialog === 'save'" title="Save">
      <v-card-text><v-text-field v-model="saveName" label="name, with .toml, or .rexs for gear data" :hint="'below ' + folder"
        persistent-hint autofocus @keyup.enter="save"></v-text-field></v-card-text>
      <v-card-actions><v-btn @click="dialog = ''">Cancel</v-btn><v-btn color="primary" @click="save">Save</v-btn></v-card-actions>
    </v-card>
    <v-card v-else-if="dialog === 'results'" title="Results">
      <v-card-text><flankfilm-results :results="results" :comparison="comparison" :call="call" :unit="unit"
        :address="address"></flankfilm-results></v-card-text>
    </v-card>
    <v-card v-else-if="dialog === 'studies'" title="Studies and optimisations">
      <v-card-text><flankfilm-studies :studies="studies" :running="running" :address="address"
        @start="startRows"></flankfilm-studies></v-card-text>
    </v-card>
    <v-card v-else title="The same for a program">
      <v-card-text><pre class="ff-code" tabindex="0">{{ shownText }}</pre></v-card-text>
    </v-card>
  </v-dialog>
</div>`;

  // The browser runs the other files before this one, or after it.
  const loaded = (name) => new Promise((resolve) => {
    const look = () => { if (window[name]) resolve(window[name]); else setTimeout(look, 20); };
    look();
  });

  const STALLED = 3000; // milliseconds without an answer after which the page says so
  const SETTLED = 1500; // milliseconds after which an answer is what the next ones are compared with
  const page = {
    template: TEMPLATE,
    inject: ["trame"],
    components: Object.fromEntries([["results", "Results"], ["studies", "Studies"], ["rows", "Rows"]].map(
      ([tag, name]) => [`flankfilm-${tag}`, Vue.defineAsyncComponent(() => loaded(`flankfilm${name}`))])),
    data: () => ({
      form: [], files: [], examples: [], results: [], comparison: null, studies: [], table: null, folder: "", opened: ["pair", "pair.pinion", "operating"], typing: "", typed: "",
      view: { values: {}, faults: {}, answers: [], sliders: [], heard: [], drawing: null, number: 0, why_no_curves: "" },
      problem: "", dialog: "", saveName: "", shownText: "", run: null, waited: 0, stalled: false, position: 0.25,
      live: null, before: null, figures: [], figuresBefore: [], fault: "", arrived: 0, waiting: {}, busy: false, seconds: 0,
    }),
    computed: {
      faulty() { return Object.keys(this.view.faults).length > 0; },
      running() { return !!this.run && this.run.status === null; },
      runTitle() {
        if (this.running) return this.run.what.startsWith("rows") ? this.run.what : `Run: ${this.run.what}`;
        if (this.run.cancelled) return this.table ? "Cancelled: Studies resumes from the rows that are there" : "Run cancelled";
        return this.run.status === 0 ? `Results in ${this.run.folder}` : `Run ended with status ${this.run.status}`;
      },
      // Counted down between what the program says; nothing once a stage takes longer than foreseen.
      timeLeft() {
        if (!this.running || this.run.left === null || this.waited > this.run.stage_left) return "";
        const left = this.run.left - this.waited;
        return left < 100 ? `about ${Math.ceil(left)} s left` : `about ${Math.ceil(left / 60)} min left`;
      },
      report() {
        return this.address(this.run.folder.slice(this.folder.length + 1));
      },
      sections() {
        const keys = Object.keys(this.view.faults);
        return this.form.map((section) => ({
          ...section, depth: section.path.split(".").length - 1,
          faults: keys.filter((key) => key && (key === section.path || section.keys.some((one) => one.path === key))).length,
        }));
      },
      teeth() { return this.view.drawing ? flankfilmCharts.mesh(this.view.drawing, this.position) : null; },
      curves() {
        if (!this.live) return [];
        const old = Object.fromEntries((this.before ? this.before.curves : []).map((curve) => [curve.name, curve]));
        return this.live.curves.map((curve) => (
          { ...curve, chart: Vue.markRaw(flankfilmCharts.chart(
            this.live.position, curve.stale ? { ...curve, lines: [] } : curve, curve.stale ? curve : old[curve.name]) || {}) }
        )).filter((curve) => curve.chart.paths);
      },
      groups() {
        const groups = new Map(), was = new Map(this.figuresBefore.map((one) => [one.group + one.name, one.text]));
        for (const one of [...this.figures, ...this.view.answers]) {
          if (!groups.has(one.group)) groups.set(one.group, []);
          const old = was.get(one.group + one.name);
          groups.get(one.group).push({ ...one, was: old !== undefined && old !== one.text ? old : "" });
        }
        return [...groups].map(([name, answers]) => ({ name, answers }));
      },
      status() {
        if (this.stalled) return "flankfilm does not answer: the connection is interrupted, or the program is busy. What you change is kept until it does.";
        if (this.faulty) return "The scene has faults: they stand beside their keys. Curves and figures are the last ones without.";
        if (this.view.why_no_curves) return this.view.why_no_curves;
        if (this.fault) return this.fault;
        if (!this.live || this.live.number !== this.view.number) return "Loaded contact: solving ...";
        return `Loaded contact solved in ${(1000 * this.seconds).toFixed(0)} ms, without film`;
      },
    },
    async mounted() {
      this.session = this.trame.client.getConnection().getSession();
      this.session.subscribe("flankfilm.told", ([message]) => this.told(message));
      setInterval(() => { this.stalled = !!this.asked && performance.now() - this.asked > STALLED; }, 500);
      setInterval(() => { this.waited = this.running ? (performance.now() - this.runTold) / 1000 : 0; }, 500);
      await loaded("flankfilmCharts");
      const answer = await this.call("start", this.tab());
      if (answer) this.form = Vue.markRaw(answer.form);
    },
    methods: {
      // The browser keeps this while the page is loaded again: the program then goes on with the edits.
      tab() {
        const kept = sessionStorage.getItem("flankfilm-tab") || crypto.randomUUID();
        sessionStorage.setItem("flankfilm-tab", kept);
        return kept;
      },
      async call(method, ...texts) {
        let answer;
        this.asked = this.asked || performance.now();
        try { answer = await this.session.call("flankfilm.call", [method, ...texts]); } catch (error) {
          this.problem = `no answer: ${error && error.message || "the connection is lost"}`;
          return null;
        }
        this.asked = 0;
        if (answer.problem || !["edit", "drag"].includes(method)) this.problem = answer.problem || "";
        this.take(answer);
        return answer;
      },
      take(answer) {
        const { view } = answer;
        if (view.number !== this.view.number) {
          this.fault = "";
          const now = performance.now();
          if (now - this.arrived > SETTLED) {
            this.before = this.live;
            this.figuresBefore = [...this.figures, ...this.view.answers];
          }
          this.arrived = now;
        }
        if (Object.keys(view.faults).length) { view.answers = this.view.answers; view.drawing = this.view.drawing; }
        if (view.why_no_curves && !Object.keys(view.faults).length) { this.live = null; this.figures = []; }
        this.view = view;
        for (const name of ["files", "examples", "results", "studies", "folder", "run"]) if (answer[name] !== undefined) this[name] = answer[name];
        if (answer.run) { this.runTold = performance.now(); this.waited = 0; }
        if (answer.notes && answer.notes.length) this.problem = answer.notes.join("; ");
      },
      told({ kind, content }) {
        if (kind === "comparison") { this.comparison = Vue.markRaw(content); return; }
        if (kind === "rows") { this.grown(content); return; }
        if (kind === "run") { this.run = content; this.runTold = performance.now(); this.waited = 0; return; }
        if (content.number !== this.view.number && !this.busy) return;
        if (content.kind === "curves") {
          const old = content.roots && this.live ? this.live.curves.find((curve) => curve.name === "root_tension") : null;
          if (old) content.curves.push({ ...old, stale: true, error: "solving ..." });
          this.live = Vue.markRaw(content); this.seconds = content.seconds; this.fault = "";
        }
        if (content.kind === "figures") this.figures = [...content.figures, ...(this.live && this.live.roots ? this.figures.filter(this.ofRoots) : [])];
        if (content.kind === "roots" && this.live) {
          const others = this.live.curves.filter((curve) => curve.name !== content.curve.name);
          this.live = Vue.markRaw({ ...this.live, curves: [...others, content.curve] });
          this.figures = [...this.figures.filter((one) => !this.ofRoots(one)), ...content.figures];
        }
        if (content.kind === "fault" && content.text) { this.fault = content.text; this.live = null; this.figures = []; }
      },
      // Only the newest value of a key waits while the program is at an older one.
      async send(method, path, text) {
        this.waiting[path] = [method, text];
        if (this.busy) return;
        this.busy = true;
        try {
          for (let next; (next = Object.keys(this.waiting)[0]) !== undefined;) {
            const [how, typed] = this.waiting[next];
            delete this.waiting[next];
            await this.call(how, next, typed);
          }
        } finally { this.busy = false; }
      },
      edit(path, text) { this.typed = text; this.send("edit", path, String(text)); },
      drag(path, text) { this.send("drag", path, text); },
      dragged(one) { const value = parseFloat(this.view.values[one.path]); return Number.isFinite(value) ? value : one.value; },
      shown(path) { return this.typing === path && this.waiting[path] ? this.waiting[path][1] : this.view.values[path] || ""; },
      ofRoots(figure) { return figure.group.startsWith("Root stress"); },
      words(key) { try { return JSON.parse(this.view.values[key.path] || "[]"); } catch { return []; } },
      unit(text) { return text.replace(/\bum\b/, "µm").replace("deg", "°"); },
      plain(text) { return text.replace(/^"|"$/g, ""); },
      async open(how, name) { this.dialog = ""; this.live = this.before = null; this.figures = []; await this.call(how, name); },
      address(name) { return `/results/${name.split("/").map(encodeURIComponent).join("/")}/report.html`; },
      async list(method, dialog) { await this.call(method); this.dialog = dialog; },
      async startRun() { this.table = null; await this.call("run"); },
      async startRows(...texts) { this.dialog = ""; this.table = null; await this.call("rows", ...texts); },
      grown({ heads, first, rows }) {
        const there = this.table || { heads: [], rows: [] };
        this.table = Vue.markRaw(heads ? { heads, rows: there.rows } : { heads: there.heads, rows: [...there.rows.slice(0, first), ...rows] });
      },
      startSaving() { this.saveName = this.view.name || "scene.toml"; this.dialog = "save"; },
      async save() { this.dialog = ""; await this.call("save", this.saveName.trim()); },
      async show(what) { const answer = await this.call(what); if (answer) { this.shownText = answer[what] || ""; this.dialog = what; } },
    },
  };
  window.flankfilm = { install: (app) => app.component("flankfilm-page", page) };
})();
