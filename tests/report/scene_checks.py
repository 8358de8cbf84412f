"""Meshes have pictures that turn, and are seen with the camera path at first."""
from selenium.webdriver.common.by import By

# A view that shows a mesh has more than one colour.
DRAWN = """
const canvas = document.createElement("canvas");
canvas.width = arguments[0].width;
canvas.height = arguments[0].height;
const context = canvas.getContext("2d", { willReadFrequently: true });
context.drawImage(arguments[0], 0, 0);
const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
const colours = new Set();
for (let i = 0; i < pixels.length && colours.size < 8; i += 4)
  colours.add(pixels[i] << 24 | pixels[i + 1] << 16 | pixels[i + 2] << 8 | pixels[i + 3]);
return colours.size;
"""
# A view has the size of its place once it is painted, which happens as it comes into view.
PAINTED = """
const views = [...arguments[0].querySelectorAll("canvas")];
return views.length > 0 && views.every((view) => view.width === Math.round(view.clientWidth * devicePixelRatio));
"""
# Positions of the recording's camera that are out of sight when a model is seen first.
PATH_OUT_OF_SIGHT = """
const [index] = arguments;
const scene = JSON.parse(document.getElementById("scenes").textContent)[index];
const camera = new THREE.PerspectiveCamera(45, 1.3, 0.01, 100);
fittedView(camera, scene, [new THREE.Vector3(...scene.low), new THREE.Vector3(...scene.high)]);
camera.updateMatrixWorld();
let count = 0;
scene.paths.forEach((path) => {
  for (let i = 0; i + 8 <= path.poses.length; i += 8) {
    const seen = new THREE.Vector3(...path.poses.slice(i + 1, i + 4)).project(camera);
    if (Math.abs(seen.x) > 1 || Math.abs(seen.y) > 1 || seen.z > 1) ++count;
  }
});
return count;
"""
PICTURE = "const picture = arguments[0].toDataURL(); return picture.length + ':' + picture.slice(-4000);"


def turn_meshes(reader):
    driver = reader.driver
    scenes = driver.find_elements(By.CSS_SELECTOR, ".scene")
    for index, scene in enumerate(scenes):
        if driver.execute_script(PATH_OUT_OF_SIGHT, index):
            reader.complain(f"the first view of model {index} cuts the camera path")
        reader.show(scene)
        if not reader.wait(PAINTED, scene):
            reader.complain("a scene shows no mesh: " + scene.text)
            continue
        views = scene.find_elements(By.CSS_SELECTOR, "canvas")
        reader.shoot("meshes")
        before = driver.execute_script(PICTURE, views[0])
        reader.show(views[0])
        reader.pointer().move_to_element(views[0]).click_and_hold().move_by_offset(60, 25).release().perform()
        reader.settle()
        for view in views:
            if driver.execute_script(DRAWN, view) < 4:
                reader.complain("a mesh has no picture: " + view.get_attribute("aria-label"))
        if driver.execute_script(PICTURE, views[0]) == before:
            reader.complain("a mesh does not turn")
        for choice in scene.find_elements(By.CSS_SELECTOR, "input"):
            reader.show(choice)
            choice.click()
            reader.settle()
        turned = driver.execute_script(PICTURE, views[0])
        scene.find_element(By.CSS_SELECTOR, "button").click()
        reader.settle()
        if driver.execute_script(PICTURE, views[0]) == turned:
            reader.complain("the view is not reset")
    return len(scenes)


def picture_in(reader, scheme, before=None):
    """The first mesh's picture in the colours of a scheme, which it takes on as it comes into view: it is not `before`."""
    driver = reader.driver
    for view in driver.find_elements(By.CSS_SELECTOR, ".scene canvas")[:1]:
        reader.show(view)
        picture = driver.execute_script(PICTURE, view)
        if picture == before:
            reader.complain(f"{scheme}: a mesh that was out of sight has the colours of before")
        return picture
    return None
