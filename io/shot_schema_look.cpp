// The keys of [[camera]], [render] and [output]: what one gets to see.
#include "io/shot_schema_keys.h"

namespace scree {
namespace {

using enum KeyType;

/// Farther out single precision, in which rays are cast, has no directions any more.
constexpr double kFarthestEye = 1e9;

const std::vector<ShotKey> kLookKeys = {
    {.path = "camera",
     .type = tableList,
     .help = "Points of view. Without any, previews frame the action by themselves, "
             "without the few bodies of many that go far from all others, and without those that "
             "fall off the set."},
    {.path = "camera.name",
     .type = text,
     .byDefault = "\"main\"",
     .help = "Identifier, unique among the cameras. The first camera is used unless told."},
    {.path = "camera.file",
     .type = text,
     .isFile = true,
     .excludes = "eye|target|fov|keys|orbit|interpolate",
     .help =
         "A glb, gltf, fbx or abc file, relative to the shot file, whose camera it is, with the "
         "motion it has there; units, axes and times as in [[import]]. Roll is kept; so "
         "is the zoom of an abc, while that of an fbx or a glTF extension is warned of. The film "
         "of an abc lies across the picture's width, or its height if that is more, as in "
         "Blender; an fbx without an angle of view has that of its film and focal length."},
    {.path = "camera.node",
     .type = text,
     .help = "Which camera of the file: the first whose name fits, with * and ? for what may be "
             "anything. Without this key, the first."},
    {.path = "camera.position",
     .type = numbers,
     .unit = "shot's unit of length",
     .excludes = "eye|keys|orbit",
     .help = "Where the origin of its file stands, as import.position. Where a camera without a "
             "file stands is its eye."},
    {.path = "camera.rotation",
     .type = numbers,
     .unit = "degrees",
     .min = -360000,
     .max = 360000,
     .excludes = "orientation|eye|keys|orbit",
     .help = "Of its file about the file's origin, as import.rotation."},
    {.path = "camera.orientation",
     .type = numbers,
     .count = 4,
     .excludes = "rotation|eye|keys|orbit",
     .help = "Rotation as a quaternion [w, x, y, z], instead of rotation; it is normalised."},
    {.path = "camera.scale",
     .min = 0,
     .isOpen = true,
     .excludes = "eye|keys|orbit",
     .help = "Factor of places in its file, as import.scale. The angle of view stays."},
    {.path = "camera.offset",
     .unit = "frames",
     .min = -1000000000,
     .max = 1000000000,
     .excludes = "eye|keys|orbit",
     .help = "As import.offset, of a camera from a file."},
    {.path = "camera.eye",
     .type = numbers,
     .unit = "shot's unit of length",
     .min = -kFarthestEye,
     .max = kFarthestEye,
     .excludes = "keys|orbit|file",
     .help = "Where it stands. A camera that moves has keys or an orbit instead."},
    {.path = "camera.target",
     .type = numbers,
     .unit = "shot's unit of length",
     .byDefault = "[0.0, 0.0, 0.0]",
     .min = -kFarthestEye,
     .max = kFarthestEye,
     .excludes = "file",
     .help = "What it looks at: the middle of the picture."},
    {.path = "camera.fov",
     .unit = "degrees",
     .byDefault = "35.0",
     .min = 0,
     .max = 180,
     .isOpen = true,
     .excludes = "file",
     .help = "Vertical angle of view. Small flattens like a long lens, large distorts the edges."},
    {.path = "camera.keys",
     .type = tableList,
     .excludes = "eye|orbit|file",
     .help = "Where it is when: keys = [{ frame = 1001, eye = [9, 3, 0] }, { frame = 1048, eye = "
             "[0, 3, 9], target = [0, 1, 0], fov = 25 }]. Before the first and after the last it "
             "rests."},
    {.path = "camera.keys.frame",
     .unit = "frames",
     .isRequired = true,
     .help = "When; may have a fraction. Frames ascend from key to key."},
    {.path = "camera.keys.eye",
     .type = numbers,
     .unit = "shot's unit of length",
     .min = -kFarthestEye,
     .max = kFarthestEye,
     .isRequired = true,
     .help = "Where it stands then."},
    {.path = "camera.keys.target",
     .type = numbers,
     .unit = "shot's unit of length",
     .min = -kFarthestEye,
     .max = kFarthestEye,
     .help = "What it looks at then. Without it, the camera's own target."},
    {.path = "camera.keys.fov",
     .unit = "degrees",
     .min = 0,
     .max = 180,
     .isOpen = true,
     .help = "Vertical angle of view then. Without it, the camera's own."},
    {.path = "camera.interpolate",
     .type = word,
     .byDefault = "\"smooth\"",
     .choices = "smooth|linear",
     .excludes = "file",
     .help = "How a keyed camera goes from key to key: \"smooth\" sets off and arrives gently, "
             "passes the keys between without a kink and never overshoots; \"linear\" goes "
             "straight on and turns at once."},
    {.path = "camera.orbit",
     .type = table,
     .excludes = "eye|keys|file",
     .help = "Goes around something at even speed: orbit = { radius = 12, height = 4, degrees = "
             "360 }."},
    {.path = "camera.orbit.centre",
     .type = numbers,
     .unit = "shot's unit of length",
     .min = -kFarthestEye,
     .max = kFarthestEye,
     .help = "What it goes around and looks at. Without it, the camera's target."},
    {.path = "camera.orbit.radius",
     .unit = "shot's unit of length",
     .min = 0,
     .max = kFarthestEye,
     .isOpen = true,
     .isRequired = true,
     .help = "Horizontal distance of the eye from the centre."},
    {.path = "camera.orbit.height",
     .unit = "shot's unit of length",
     .byDefault = "0.0",
     .min = -kFarthestEye,
     .max = kFarthestEye,
     .help = "Of the eye above the centre."},
    {.path = "camera.orbit.start",
     .unit = "degrees",
     .byDefault = "0.0",
     .min = -36000,
     .max = 36000,
     .help = "Where it begins. 0 is in front of the centre, towards +z (with z up: towards -y); 90 "
             "is towards +x."},
    {.path = "camera.orbit.degrees",
     .unit = "degrees",
     .byDefault = "360.0",
     .min = -36000,
     .max = 36000,
     .help = "How far it goes, against the clock seen from above; negative goes with it."},
    {.path = "camera.orbit.frames",
     .type = text,
     .unit = "frames",
     .help = "\"FIRST-LAST\": when it goes. Before and after it stands still. Without it, all of "
             "the shot. A turn of 360 shows the first picture again as the last: loops leave it "
             "out."},
    {.path = "render", .type = table, .byDefault = "{}", .help = "Preview pictures."},
    {.path = "render.size",
     .type = integers,
     .count = 2,
     .unit = "pixels",
     .byDefault = "[1280, 720]",
     .min = 16,
     .max = 16384,
     .help = "Width and height."},
    {.path = "render.burnin",
     .type = boolean,
     .help = "Whether shot, frame, time, bodies and worst overlap are written into the pictures: "
             "yes unless said otherwise. `scree render --burnin` and `--no-burnin` overrule it."},
    {.path = "render.motion_blur",
     .type = integer,
     .unit = "moments",
     .min = 1,
     .max = 1000,
     .help = "Pictures are the mean of so many moments while the shutter is open: from the first "
             "to the last of output.subframes, or a quarter of a frame either way. 1, or none, is "
             "no blur; below 8, fast bodies show as several."},
    {.path = "render.still",
     .type = integer,
     .unit = "frame",
     .min = -1000000000,
     .max = 1000000000,
     .help = "The frame that stands for the shot where one picture must, as in tools/gallery. "
             "Without it, the last."},
    {.path = "output",
     .type = table,
     .byDefault = "{}",
     .help = "What is written when the simulation ends."},
    {.path = "output.export",
     .type = words,
     .byDefault = "[]",
     .choices = "abc|usda|instances.usda|glb|obj|ply|pov",
     .help = "Caches for other programs, by file name ending. They can be made later as well."},
    {.path = "output.subframes",
     .type = numbers,
     .count = 0,
     .unit = "frames",
     .byDefault = "[]",
     .min = -1,
     .max = 1,
     .isOpen = true,
     .help = "Samples around every frame, for motion blur: [-0.25, 0.0, 0.25] suits a shutter that "
             "is open for half a frame about it. 0 is always among them; all lie within one "
             "frame, at least 0.01 apart. They are taken from the sub-steps and never change the "
             "simulation; each makes the take larger by a third. Without them renderers blur along "
             "straight lines from frame to frame, which shows where things spin or hit. What turns "
             "by more than half round between two of them needs more of them in an export, whose "
             "readers take the shorter way; render knows how often it turned."},
    {.path = "output.contacts",
     .type = boolean,
     .byDefault = "false",
     .help = "Whether every frame also keeps what the step that ended there did: contact points, "
             "normals and impulses, and for every body its level of the contact graph and its "
             "deepest overlap. `scree render --look contacts`, `levels` and `overlap` show them. "
             "The simulation does not change; a heap's frames grow by half or more."},
};

}  // namespace

void appendLookKeys(std::vector<ShotKey>& keys)
{
    keys.insert(keys.end(), kLookKeys.begin(), kLookKeys.end());
}

}  // namespace scree
