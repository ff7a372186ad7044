// Studies and optimisations: the list with their rows, and the table that grows while they are computed.
window.flankfilmStudies = {
  template: `
<div class="ff">
  <ul class="ff-kept">
    <li v-for="one in studies" :key="one.example + one.name">
      <b>{{ one.title || one.name }}</b> <span>{{ one.kind === "study" ? "study" : "optimisation" }}, {{ one.example ? "example " : "" }}{{ one.name }}</span>
      <span class="ff-row">
        <v-btn v-if="!one.rows" size="small" variant="tonal" :disabled="running" @click="start(one, '')">Start</v-btn>
        <v-btn v-else size="small" variant="tonal" :disabled="running" @click="start(one, 'resume')">Resume</v-btn>
        <span v-if="one.rows">{{ one.rows }} rows in {{ one.folder }}</span>
        <a v-if="one.report" :href="address(one.folder)" target="_blank" rel="noopener">report</a></span>
    </li>
  </ul>
</div>`,
  props: { studies: Array, running: Boolean, address: Function },
  emits: ["start"],
  methods: { start(one, resume) { this.$emit("start", one.name, one.example ? "example" : "", resume); } },
};

window.flankfilmRows = {
  template: `
<details class="ff-rows" open>
  <summary>Rows: {{ table.rows.length }}{{ table.rows.length > shown.length ? ", the last " + shown.length + " are shown" : "" }}</summary>
  <div class="ff-wide ff-tall" tabindex="0" role="region" aria-label="Table of rows"><table>
    <thead><tr><th v-for="head in table.heads" :key="head.name" :title="head.name + ': ' + head.meaning">{{ short(head.name) }}
      <small v-if="head.unit">{{ unit(head.unit) }}</small></th></tr></thead>
    <tbody><tr v-for="row in shown" :key="row[0]"><td v-for="(cell, k) in row" :class="{ 'ff-value': !isNaN(cell) }">{{ brief(cell) }}</td></tr></tbody>
  </table></div>
</details>`,
  props: { table: Object, unit: Function },
  computed: { shown() { return this.table.rows.slice(-200).reverse(); } },
  methods: {
    // Six digits of a number that has more; the file holds all.
    brief(cell) { return cell === "" || isNaN(cell) || cell.length <= 9 ? cell : String(Number(Number(cell).toPrecision(6))); },
    short(name) { return name.includes(".") ? name.split(".").slice(-3).join(".") : name; },
  },
};
