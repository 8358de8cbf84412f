// Draws the meshes of a page with three.js. One WebGL context serves all views: each view is a plain canvas that
// the picture is copied to, so that a page may hold any number of them, and prints.
"use strict";
(function () {
  const scenes = JSON.parse(document.getElementById("scenes").textContent);

  function bytes(text) {
    const binary = atob(text);
    const result = new Uint8Array(binary.length);
    for (let i = 0; i < binary.length; ++i) result[i] = binary.charCodeAt(i);
    return result;
  }

  function geometryOf(mesh) {
    const quantised = new Uint16Array(bytes(mesh.positions).buffer);
    const positions = new Float32Array(quantised.length);
    for (let i = 0; i < quantised.length; ++i) positions[i] = mesh.low[i % 3] + mesh.size[i % 3] * quantised[i] / 65535;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(bytes(mesh.triangles).buffer), 1));
    geometry.computeVertexNormals();
    return geometry;
  }

  function element(tag, parent, text) {
    const made = document.createElement(tag);
    if (text !== undefined) made.textContent = text;
    parent.appendChild(made);
    return made;
  }

  let renderer = null;
  try {
    renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  } catch (error) {
    document.querySelectorAll(".scene").forEach((host) => element("p", host, "The meshes need WebGL, which this browser does not offer."));
    return;
  }

  function viewOf(mesh, host) {
    const figure = element("div", host);
    element("div", figure, mesh.label);
    const canvas = element("canvas", figure);
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", "mesh: " + mesh.label);
    const geometry = geometryOf(mesh);
    const scene = new THREE.Scene();
    const object = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: THREE.VertexColors, side: THREE.DoubleSide }));
    scene.add(object);
    scene.add(new THREE.AmbientLight(0xffffff, 0.55));
    const light = new THREE.DirectionalLight(0xffffff, 0.55);
    scene.add(light);
    return { mesh: mesh, canvas: canvas, scene: scene, light: light, geometry: geometry, material: object.material };
  }

  function paint(view, errors) {
    const text = errors && view.mesh.errors !== "" ? view.mesh.errors : view.mesh.colors;
    view.geometry.setAttribute("color", new THREE.BufferAttribute(bytes(text), 3, true));
  }

  function choose(host, name, text, checked, change) {
    const label = element("label", host);
    const input = element("input", label);
    input.type = "radio";
    input.name = name;
    input.checked = checked;
    label.appendChild(document.createTextNode(" " + text));
    input.addEventListener("change", change);
  }

  function start(description, index) {
    const host = document.getElementById("scene-" + index);
    const bar = element("div", host);
    bar.className = "bar";
    const grid = element("div", host);
    grid.className = "views";
    const views = description.meshes.map((mesh) => viewOf(mesh, grid));
    const centre = new THREE.Vector3(...description.centre);
    const radius = Math.max(description.radius_m, 1e-3);
    const camera = new THREE.PerspectiveCamera(45, 1, 0.01 * radius, 50 * radius);
    camera.up.set(...description.up);
    const home = centre.clone().add(camera.up.clone().multiplyScalar(0.9 * radius))
      .add(new THREE.Vector3(0.55, 0.35, -1).normalize().multiplyScalar(2.1 * radius));
    camera.position.copy(home);
    camera.lookAt(centre);

    function render() {
      views.forEach((view) => {
        const scale = window.devicePixelRatio || 1;
        const width = Math.max(1, Math.round(view.canvas.clientWidth * scale));
        const height = Math.max(1, Math.round(view.canvas.clientHeight * scale));
        if (view.canvas.width !== width || view.canvas.height !== height) {
          view.canvas.width = width;
          view.canvas.height = height;
        }
        camera.aspect = width / height;
        camera.updateProjectionMatrix();
        view.light.position.copy(camera.position).sub(centre);
        renderer.setSize(width, height, false);
        renderer.setClearColor(getComputedStyle(document.documentElement).getPropertyValue("--back").trim());
        renderer.render(view.scene, camera);
        view.canvas.getContext("2d").drawImage(renderer.domElement, 0, 0);
      });
    }

    const hasErrors = description.meshes.some((mesh) => mesh.errors !== "");
    const show = (errors) => { views.forEach((view) => paint(view, errors)); render(); };
    if (hasErrors) {
      choose(bar, "colours-" + index, "error", true, () => show(true));
      choose(bar, "colours-" + index, "surface", false, () => show(false));
      const legend = element("span", bar, "distance to the true surface: 0 ");
      element("span", legend).className = "ramp";
      legend.appendChild(document.createTextNode(" " + Number((100 * description.largest_error_m).toPrecision(3)) + " cm and more"));
    }
    const reset = element("button", bar, "reset view");
    reset.type = "button";
    element("span", bar, "drag to turn, wheel to zoom, right button to move");

    const controls = views.map((view) => {
      const control = new THREE.OrbitControls(camera, view.canvas);
      control.target.copy(centre);
      control.enableKeys = false;
      control.update();
      control.addEventListener("change", render);
      return control;
    });
    // All views turn about one target.
    controls.forEach((control) => control.addEventListener("change", () => {
      controls.forEach((other) => { if (other !== control) other.target.copy(control.target); });
    }));
    reset.addEventListener("click", () => {
      camera.position.copy(home);
      controls.forEach((control) => { control.target.copy(centre); });
      camera.lookAt(centre);
      render();
    });
    show(hasErrors);
    window.addEventListener("resize", render);
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", render);
  }

  // A scene is prepared when it comes into view, or is printed.
  const waiting = new Set(scenes.keys());
  function prepare(index) {
    if (waiting.delete(index)) start(scenes[index], index);
  }
  const observer = new IntersectionObserver((entries) => entries.forEach((entry) => {
    if (entry.isIntersecting) prepare(Number(entry.target.id.slice("scene-".length)));
  }), { rootMargin: "300px" });
  scenes.forEach((_, index) => observer.observe(document.getElementById("scene-" + index)));
  window.addEventListener("beforeprint", () => scenes.forEach((_, index) => prepare(index)));
})();
