// Draws the meshes of a page with three.js, in place of their pictures. One WebGL context serves all views: each view is a
// plain canvas that the picture is copied to, so that a page may hold any number of them. Paper shows the pictures.
"use strict";
(function () {
  const scenes = JSON.parse(document.getElementById("scenes").textContent);
  const unprepared = new Set(scenes.keys());
  const inSight = new Set();
  const refreshers = new Map();  // of prepared scenes: brings their pictures up to date

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
    if (mesh.discs) return discGeometry(geometry, positions, mesh.discs);
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(bytes(mesh.triangles).buffer), 1));
    geometry.computeVertexNormals();
    return geometry;
  }

  // Surfels are drawn as hexagons across their normals.
  const corners = 6;
  function discGeometry(geometry, middles, discs) {
    const normals = new Int8Array(bytes(discs.normals).buffer), radii = bytes(discs.radii);
    const positions = new Float32Array(corners * middles.length), directions = new Float32Array(corners * middles.length);
    const fan = corners - 2;
    const triangles = new Uint32Array(3 * fan * radii.length);
    const normal = new THREE.Vector3(), across = new THREE.Vector3(), up = new THREE.Vector3(), corner = new THREE.Vector3();
    for (let i = 0; i < radii.length; ++i) {
      normal.set(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]).normalize();
      across.set(1, 0, 0);
      if (Math.abs(normal.x) > 0.7) across.set(0, 1, 0);
      up.crossVectors(normal, across).normalize();
      across.crossVectors(up, normal);
      const radius = discs.largest_radius_m * Math.max(radii[i], 1) / 255;
      for (let k = 0; k < corners; ++k) {
        const angle = 2 * Math.PI * k / corners;
        corner.fromArray(middles, 3 * i).addScaledVector(across, radius * Math.cos(angle)).addScaledVector(up, radius * Math.sin(angle));
        corner.toArray(positions, 3 * (corners * i + k));
        normal.toArray(directions, 3 * (corners * i + k));
      }
      for (let k = 0; k < fan; ++k) triangles.set([corners * i, corners * i + k + 1, corners * i + k + 2], 3 * (fan * i + k));
    }
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(directions, 3));
    geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    return geometry;
  }

  /// Of each vertex of what is drawn.
  function coloursOf(mesh, text) {
    const given = bytes(text);
    if (!mesh.discs) return given;
    const colours = new Uint8Array(corners * given.length);
    for (let i = 0; i < given.length / 3; ++i) {
      for (let k = 0; k < corners; ++k) colours.set(given.subarray(3 * i, 3 * i + 3), 3 * (corners * i + k));
    }
    return colours;
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
    document.querySelectorAll(".scene").forEach((host) => element("p", host, "These are pictures. Models that turn need WebGL, which this browser does not offer."));
    return;
  }

  document.querySelectorAll(".scene").forEach((host) => host.classList.add("turning"));

  function viewOf(mesh, host) {
    const figure = element("div", host);
    figure.dataset.run = mesh.label;
    element("div", figure, mesh.label);
    const canvas = element("canvas", figure);
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", "mesh: " + mesh.label);
    const geometry = geometryOf(mesh);
    const scene = new THREE.Scene();
    const object = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: THREE.VertexColors, side: THREE.DoubleSide }));
    scene.add(object);
    // Dark surfaces stay visible: much of the light comes from everywhere.
    scene.add(new THREE.AmbientLight(0xffffff, 0.85));
    const light = new THREE.DirectionalLight(0xffffff, 0.45);
    scene.add(light);
    return { mesh: mesh, figure: figure, canvas: canvas, scene: scene, light: light, geometry: geometry, path: null };
  }

  function paint(view, errors) {
    const text = errors && view.mesh.errors !== "" ? view.mesh.errors : view.mesh.colors;
    view.geometry.setAttribute("color", new THREE.BufferAttribute(coloursOf(view.mesh, text), 3, true));
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
    const pictures = host.querySelectorAll(".stills figure");
    if (views.length === 1) grid.classList.add("single");
    const camera = new THREE.PerspectiveCamera(45, 1, 0.01, 100);
    const shapeOf = (canvas) => Math.max(1, canvas.clientWidth) / Math.max(1, canvas.clientHeight);
    camera.aspect = shapeOf(views[0].canvas);
    const home = fittedView(camera, description, views.flatMap((view) => somePoints(view.geometry, 1500 / views.length)));
    const centre = home.centre;
    const pathColour = (path) => colour("--series-" + (path.colour % seriesColours));
    views.forEach((view) => {
      const path = description.paths.find((other) => other.label === view.mesh.label);
      if (!path || path.poses.length < 8) return;
      view.path = cameraPath(path, 0.16 * home.radius, pathColour(path));
      view.description = path;
      view.scene.add(view.path);
    });

    // Out of sight, a view is drawn only once it comes into sight.
    let stale = false;
    function render() {
      stale = !inSight.has(index);
      if (!stale) renderViews();
    }
    refreshers.set(index, () => { if (stale) renderViews(); stale = false; });

    function renderViews() {
      views.forEach((view) => {
        if (view.figure.hidden) return;
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
        // Of the same size, it would be made anew for each view.
        if (renderer.domElement.width !== width || renderer.domElement.height !== height) renderer.setSize(width, height, false);
        renderer.setClearColor(getComputedStyle(document.documentElement).getPropertyValue("--scene").trim());
        renderer.render(view.scene, camera);
        view.canvas.getContext("2d").drawImage(renderer.domElement, 0, 0);
      });
    }

    const hasErrors = description.meshes.some((mesh) => mesh.errors !== "");
    let scale = null;
    const show = (errors) => {
      if (scale) scale.hidden = !errors;
      views.forEach((view) => paint(view, errors));
      render();
    };
    if (hasErrors) {
      choose(bar, "colours-" + index, "error", true, () => show(true));
      choose(bar, "colours-" + index, "surface", false, () => show(false));
      scale = element("span", bar, "distance to the true surface: 0 ");
      element("span", scale).className = "ramp";
      scale.appendChild(document.createTextNode(" " + Number((100 * description.largest_error_m).toPrecision(3)) + " cm and more"));
    }
    const reset = element("button", bar, "reset view");
    reset.type = "button";
    let withPaths = true;
    if (views.some((view) => view.path)) {
      const label = element("label", bar);
      const box = element("input", label);
      box.type = "checkbox";
      box.checked = true;
      label.appendChild(document.createTextNode(" camera"));
      box.addEventListener("change", () => {
        withPaths = box.checked;
        views.forEach((view) => { if (view.path) view.path.visible = withPaths; });
        render();
      });
    }
    element("span", bar, "drag or arrow keys to turn, wheel or + and - to zoom, right button to move");

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
      camera.position.copy(home.position);
      controls.forEach((control) => { control.target.copy(centre); });
      camera.lookAt(centre);
      render();
    });
    views.forEach((view) => {
      view.canvas.tabIndex = 0;
      view.canvas.addEventListener("keydown", (event) => { if (turn(event.key)) event.preventDefault(); });
    });

    /// By a key; false: it is none of a view.
    function turn(key) {
      const target = controls[0].target;
      const offset = camera.position.clone().sub(target);
      const angle = { ArrowLeft: -0.1, ArrowRight: 0.1 }[key];
      const tilt = { ArrowUp: 0.1, ArrowDown: -0.1 }[key];
      const zoom = { "+": 0.9, "-": 1.1 }[key];
      if (angle) offset.applyAxisAngle(camera.up, angle);
      else if (zoom) offset.multiplyScalar(zoom);
      else if (tilt) {
        const side = new THREE.Vector3().crossVectors(camera.up, offset).normalize();
        const tilted = offset.clone().applyAxisAngle(side, -tilt);
        if (tilted.angleTo(camera.up) > 0.1 && tilted.angleTo(camera.up) < 3.0) offset.copy(tilted);
      } else return false;
      camera.position.copy(target).add(offset);
      camera.lookAt(target);
      render();
      return true;
    }

    let waiting = false;
    const renderSoon = () => {
      if (!waiting) requestAnimationFrame(() => { waiting = false; render(); });
      waiting = true;
    };
    window.addEventListener("time-chosen", (event) => {
      if (event.detail.part !== description.part) return;
      views.forEach((view) => { if (view.path) view.path.userData.show(event.detail.time_s); });
      renderSoon();
    });
    window.addEventListener("run-shown", (event) => {
      if (event.detail.part !== description.part) return;
      views.forEach((view, i) => { if (isOf(view.mesh.label, event.detail.run)) view.figure.hidden = pictures[i].hidden = !event.detail.visible; });
      renderSoon();
    });
    window.addEventListener("charts-drawn", () => {
      views.forEach((view) => { if (view.path) view.path.userData.colour(pathColour(view.description)); });
      render();
    });
    show(hasErrors);
    window.addEventListener("resize", render);
  }

  // A scene is prepared when it comes into view.
  function prepare(index) {
    if (unprepared.delete(index)) start(scenes[index], index);
    refreshers.get(index)();
  }
  const observer = new IntersectionObserver((entries) => entries.forEach((entry) => {
    const index = Number(entry.target.id.slice("scene-".length));
    if (!entry.isIntersecting) {
      inSight.delete(index);
      return;
    }
    inSight.add(index);
    prepare(index);
  }), { rootMargin: "300px" });
  scenes.forEach((_, index) => observer.observe(document.getElementById("scene-" + index)));
})();
