// An object or the robot, out of meshes that the server made, or else the floor. Objects have a name and two rings.
import { CSS2DObject, THREE } from "nicegui-scene";

function part({ vertices, normals, triangles, color, opacity }) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(vertices, 3));
  geometry.setAttribute("normal", new THREE.Float32BufferAttribute(normals, 3));
  geometry.setIndex(triangles);
  const paint = new THREE.Color().setRGB(...color, THREE.SRGBColorSpace);
  const material = new THREE.MeshLambertMaterial({ color: paint, opacity, transparent: opacity < 1 });
  return new THREE.Mesh(geometry, material);
}

function ring(radius, width, color) {
  const material = new THREE.MeshBasicMaterial({ color, transparent: true });
  const mesh = new THREE.Mesh(new THREE.RingGeometry(radius, radius + width, 48), material);
  mesh.position.z = 0.02;
  mesh.visible = false;
  return mesh;
}

// Lines a metre apart, in short pieces, since some browsers leave out a line that passes the viewer.
function floor(size) {
  const ends = [], far = size / 2, piece = 4;
  for (let a = -far; a <= far; a++)
    for (let b = -far; b < far; b += piece) ends.push(a, b, 0, a, b + piece, 0, b, a, 0, b + piece, a, 0);
  const geometry = new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(ends, 3));
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: 0xccc9c4 }));
}

export default class Body {
  async create_mesh(url, name, radius, height) {
    if (!url) return floor(40);
    const group = new THREE.Group();
    group.add(...(await (await fetch(url)).json()).map(part));
    if (!name) return group;
    const text = document.createElement("div");
    text.className = "name";
    text.textContent = name;
    const label = new CSS2DObject(text);
    label.position.z = height + 0.16;
    group.userData = { text, meant: ring(radius + 0.05, 0.11, "#f59e0b"), pointed: ring(radius + 0.18, 0.06, "#1d4ed8") };
    return group.add(label, group.userData.meant, group.userData.pointed);
  }
}
