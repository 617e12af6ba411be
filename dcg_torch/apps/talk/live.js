// The camera's picture, and what else changes many times a second: where the robot is, what it has seen, what it takes
// to be meant. The server makes each message once for all visitors; between two of them the robot's motion is drawn on.
const ROBOT = "/robot"; // no object's id has a slash

function signature({ scene, camera, renderer }) {
  const { x, y, z, w } = camera.quaternion;
  const all = [renderer.domElement.width, renderer.domElement.height, camera.projectionMatrix.elements[5]];
  all.push(...camera.position.toArray(), x, y, z, w);
  scene.traverse((o) => all.push(o.visible, ...o.position.toArray(), o.rotation.z, o.material?.opacity));
  return all.map((value) => Math.round(1e4 * value)).join(); // the controls of the view tremble in the last digits
}

export default {
  template: `<img>`,
  props: { view: Number, pointed: String },

  mounted() {
    this.state = { seen: [], marks: {} };
    this.timer = setInterval(() => this.attach(), 200);
    this.connect();
  },
  unmounted() {
    clearInterval(this.timer);
    this.socket.onclose = null;
    this.socket.close();
  },

  methods: {
    connect() {
      this.socket = new WebSocket(`${location.protocol.replace("http", "ws")}//${location.host}/live`);
      this.socket.onmessage = ({ data }) => (data instanceof Blob ? this.show(data) : this.hear(JSON.parse(data)));
      this.socket.onclose = () => setTimeout(() => this.connect(), 1000);
    },
    show(picture) {
      URL.revokeObjectURL(this.$el.src);
      this.$el.src = URL.createObjectURL(picture);
    },
    hear(news) {
      Object.assign(this.state, news);
      if (!news.pose) return;
      const now = performance.now();
      this.from = this.stands ?? news.pose;
      this.takes = Math.min(150, Math.max(30, now - (this.since ?? 0))); // as long as the next message will, probably
      this.since = now;
    },
    // The scene of NiceGUI draws all the time; where no graphics card does it that takes a whole core.
    attach() {
      const view = getElement(this.view);
      if (!view?.renderer || view === this.attached) return;
      this.attached = view;
      const draw = view.renderer.render.bind(view.renderer), write = view.text_renderer.render.bind(view.text_renderer);
      let drawn = "";
      view.text_renderer.render = () => {}; // with the scene
      view.text3d_renderer.render = () => {}; // there is none
      view.renderer.render = (scene, camera) => {
        this.move(view);
        this.mark(view);
        const now = signature(view);
        if (now === drawn) return;
        drawn = now;
        draw(scene, camera);
        write(scene, camera);
      };
      window.addEventListener("resize", () => (drawn = "")); // which clears it
    },
    move(view) {
      const robot = view.scene.getObjectByName(ROBOT), to = this.state.pose;
      if (!robot || !to) return;
      const far = Math.hypot(to[0] - this.from[0], to[1] - this.from[1]) > 0.5; // another world
      const share = far ? 1 : Math.min(1, (performance.now() - this.since) / this.takes);
      const turn = Math.atan2(Math.sin(to[2] - this.from[2]), Math.cos(to[2] - this.from[2]));
      const way = [to[0] - this.from[0], to[1] - this.from[1], turn];
      this.stands = way.map((part, k) => this.from[k] + share * part);
      robot.position.set(this.stands[0], this.stands[1], 0);
      robot.rotation.z = this.stands[2];
    },
    mark(view) {
      for (const { mesh } of view.objects.values()) {
        const { text, meant, pointed } = mesh?.userData ?? {};
        if (!text) continue;
        const share = Math.round(10 * (this.state.marks[mesh.name] ?? 0)) / 10;
        text.classList.toggle("seen", this.state.seen.includes(mesh.name));
        meant.visible = share > 0;
        meant.material.opacity = 0.1 + 0.9 * share;
        pointed.visible = mesh.name === this.pointed;
      }
    },
  },
};
