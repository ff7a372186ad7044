// Results that the folder keeps, and those that are ticked side by side: curves over each other, and differences.
window.flankfilmResults = {
  template: `
<div class="ff ff-results">
  <p v-if="!results.length">The folder keeps no results yet: <b>Run</b> makes some.</p>
  <ul class="ff-kept">
    <li v-for="one in results" :key="one.name">
      <label><input type="checkbox" :value="one.name" v-model="ticked" :disabled="ticked.length >= 6 && !ticked.includes(one.name)">
        <b>{{ one.scene }}</b> <span>{{ one.date }}</span></label>
      <a :href="address(one.name)" target="_blank" rel="noopener">report</a>
      <small v-for="figure in one.figures">{{ unit(figure) }}</small>
    </li>
  </ul>
  <v-btn size="small" color="primary" :disabled="ticked.length < 2" @click="compare">Compare {{ ticked.length || "" }}</v-btn>
  <p v-if="waiting" role="status">Reading ...</p>
  <p v-if="comparison && comparison.problem" class="ff-fault" role="alert">{{ comparison.problem }}</p>
  <div v-if="comparison && comparison.runs" class="ff-side">
    <ol class="ff-legend"><li v-for="(run, k) in comparison.runs" :key="run">
      <svg viewBox="0 0 40 10" aria-hidden="true"><path :class="line(k)" d="M0 5H40"></path></svg> {{ run }}</li></ol>
    <div class="ff-curves">
      <figure v-for="curve in curves" :key="curve.name">
        <figcaption><b>{{ curve.label }}</b>{{ curve.unit ? " [" + curve.unit + "]" : "" }}
          <small v-for="text in curve.errors">{{ text }}</small></figcaption>
        <svg :viewBox="'0 0 ' + curve.chart.wide + ' ' + curve.chart.tall" role="img" :aria-label="curve.label">
          <g v-for="row in curve.chart.rows"><line class="ff-grid" :x1="curve.chart.left" :x2="curve.chart.right" :y1="row.y" :y2="row.y"></line>
            <text text-anchor="end" :x="curve.chart.left - 6" :y="row.y + 4">{{ row.text }}</text></g>
          <text v-for="column in curve.chart.columns" text-anchor="middle" :x="column.x" :y="curve.chart.bottom + 16">{{ column.text }}</text>
          <text text-anchor="end" :x="curve.chart.right" :y="curve.chart.tall - 3">position [base pitches]</text>
          <template v-for="(paths, k) in curve.chart.runs"><path v-for="d in paths" :class="line(place(curve, k))" :d="d"></path></template>
        </svg>
      </figure>
    </div>
    <p>{{ comparison.about }} Differences are against the first run that has the figure; <b>bold</b> ones are larger than
      both errors together. {{ comparison.equal }} figures are equal to the last digit.</p>
    <div class="ff-wide" tabindex="0" role="region" aria-label="Table of differences"><table>
      <thead><tr><th>figure</th><th>unit</th><template v-for="(run, k) in comparison.runs">
        <th>{{ run }}</th><th v-if="k">difference</th></template></tr></thead>
      <tbody><tr v-for="row in comparison.rows" :key="row.name"><td :title="row.name">{{ row.label }}</td><td>{{ unit(row.unit) }}</td>
        <template v-for="(value, k) in row.values"><td class="ff-value">{{ value || "-" }}</td>
          <td v-if="k" class="ff-value"><b v-if="row.real[k]">{{ row.differences[k] }}</b><span v-else>{{ row.differences[k] }}</span></td></template>
      </tr></tbody></table></div>
  </div>
</div>`,
  props: { results: Array, comparison: Object, call: Function, unit: Function, address: Function },
  data: () => ({ ticked: [], waiting: false }),
  watch: { comparison() { this.waiting = false; } },
  computed: {
    curves() {
      return this.comparison.curves.map((curve) => ({
        ...curve, chart: flankfilmCharts.overlay(curve.runs),
        errors: new Set(curve.runs.map((run) => run.error)).size === 1 ? [curve.runs[0].error] : curve.runs.map((run) => `${run.run}: ${run.error}`),
      }))
        .filter((curve) => curve.chart);
    },
  },
  methods: {
    compare() { this.waiting = true; this.call("compare", ...this.ticked); },
    line(k) { return `ff-line ff-line${k % 4} ff-dash${Math.floor(k / 4)}`; },
    place(curve, k) { return this.comparison.runs.indexOf(curve.runs[k].run); },
  },
};
