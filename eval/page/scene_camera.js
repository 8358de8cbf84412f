// Where the camera of a 3D view stands at first, and how a recording's camera path is drawn.
"use strict";

/// Positions of the paths that are not far from the meshes: a lost camera's would make them small.
function nearPlaces(paths, box) {
  const around = box.clone().expandByScalar(box.getSize(new THREE.Vector3()).length());
  const places = [];
  paths.forEach((path) => {
    for (let i = 0; i + 8 <= path.poses.length; i += 8) places.push(new THREE.Vector3(...path.poses.slice(i + 1, i + 4)));
  });
  return places.filter((place) => around.containsPoint(place));
}

/// Looks along `ahead`, a little from above, from as near as the paths and almost all of the points are in view.
function fittedView(camera, description, points) {
  const box = new THREE.Box3(new THREE.Vector3(...description.low), new THREE.Vector3(...description.high));
  const inBox = points.filter((point) => box.containsPoint(point));
  const places = nearPlaces(description.paths, box);
  places.forEach((place) => box.expandByPoint(place));
  const low = box.min, high = box.max;
  const centre = low.clone().add(high).multiplyScalar(0.5);
  const radius = Math.max(high.clone().sub(low).length() / 2, 1e-3);
  const most = 0.995;
  Object.assign(camera, { near: 0.01 * radius, far: 50 * radius });
  camera.updateProjectionMatrix();
  const up = new THREE.Vector3(...description.up);
  const back = new THREE.Vector3(...description.ahead).negate().add(up.clone().multiplyScalar(0.25)).normalize();
  camera.up.copy(up);
  const seen = new THREE.Vector3();
  for (let distance = 0.3 * radius; distance < 20 * radius; distance *= 1.04) {
    camera.position.copy(centre).add(back.clone().multiplyScalar(distance));
    camera.lookAt(centre);
    camera.updateMatrixWorld();
    const isSeen = (point) => {
      seen.copy(point).project(camera);
      return Math.abs(seen.x) < 0.95 && Math.abs(seen.y) < 0.92 && seen.z < 1;
    };
    if (places.every(isSeen) && inBox.filter(isSeen).length >= most * inBox.length) break;
  }
  return { position: camera.position.clone(), centre: centre, radius: radius };
}

/// About so many of a geometry's points.
function somePoints(geometry, count) {
  const positions = geometry.getAttribute("position");
  const step = Math.max(1, Math.floor(positions.count / count));
  const points = [];
  for (let i = 0; i < positions.count; i += step) points.push(new THREE.Vector3().fromBufferAttribute(positions, i));
  return points;
}

/// Edges of a pyramid from the camera's centre, as pairs of points.
function frustumPoints(pose, depth) {
  const q = new THREE.Quaternion(pose[4], pose[5], pose[6], pose[7]);
  const p = new THREE.Vector3(pose[1], pose[2], pose[3]);
  const place = (x, y, z) => new THREE.Vector3(x, y, z).multiplyScalar(depth).applyQuaternion(q).add(p);
  const tip = place(0, 0, 0);
  const corners = [[-0.55, -0.41], [0.55, -0.41], [0.55, 0.41], [-0.55, 0.41]].map(([x, y]) => place(x, y, 1));
  return corners.flatMap((corner, i) => [tip, corner, corner, corners[(i + 1) % 4]]);
}

/// The path, frusta along it, and one that stands where the camera was at the chosen time.
function cameraPath(description, size, colour) {
  const poses = [];
  for (let i = 0; i + 8 <= description.poses.length; i += 8) poses.push(description.poses.slice(i, i + 8));
  const group = new THREE.Group();
  const lines = (points, Kind, opacity) => {
    const material = new THREE.LineBasicMaterial({ color: colour, transparent: opacity < 1, opacity: opacity });
    const made = new Kind(new THREE.BufferGeometry().setFromPoints(points), material);
    group.add(made);
    return made;
  };
  lines(poses.map((pose) => new THREE.Vector3(pose[1], pose[2], pose[3])), THREE.Line, 1);
  const frusta = 8;
  const some = poses.filter((_, i) => i % Math.max(1, Math.ceil(poses.length / frusta)) === 0);
  lines(some.flatMap((pose) => frustumPoints(pose, 0.5 * size)), THREE.LineSegments, 0.55);
  const current = lines(frustumPoints(poses[0], size), THREE.LineSegments, 1);
  group.userData.show = (time) => {
    const pose = poses.reduce((best, other) => Math.abs(other[0] - time) < Math.abs(best[0] - time) ? other : best);
    current.geometry.setFromPoints(frustumPoints(pose, size));
  };
  group.userData.colour = (value) => group.children.forEach((child) => child.material.color.set(value));
  return group;
}
