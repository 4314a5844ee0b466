// The keys of what is in the world: [[body]], [[force]], [[pair]], [[import]], [[emitter]].
#include "io/shot_schema_keys.h"

namespace scree {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using enum KeyType;

const std::vector<ShotKey> kBodyKeys = {
    {.path = "body",
     .type = tableList,
     .help = "Things in the world, each [[body]] one of them, or many by grid or poses."},
    {.path = "body.name",
     .type = text,
     .isRequired = true,
     .help = "Identifier, unique in the shot (letters, digits, _; no digit first): the object's "
             "name in every export."},
    {.path = "body.shape",
     .type = text,
     .excludes = "plane",
     .help = "Name of a [shape.NAME]. Each body has a shape or a plane."},
    {.path = "body.plane",
     .type = table,
     .excludes = "shape|position|rotation|orientation|velocity|spin|mass|grid|poses|force|torque|"
                 "start|keys",
     .help = "Everything on one side of a plane is solid. Only static bodies can be planes."},
    {.path = "body.plane.point",
     .type = numbers,
     .unit = "shot's unit of length",
     .byDefault = "[0.0, 0.0, 0.0]",
     .help = "A point of the plane; pictures and exports centre their square there."},
    {.path = "body.plane.normal",
     .type = numbers,
     .isRequired = true,
     .help = "Direction out of the solid; any length but zero."},
    {.path = "body.material",
     .type = text,
     .isRequired = true,
     .help = "Name of a [material.NAME]."},
    {.path = "body.motion",
     .type = word,
     .byDefault = "\"dynamic\"",
     .choices = "dynamic|static|keyed",
     .help = "\"dynamic\" bodies are moved by gravity and impulses; \"static\" ones never move, "
             "whatever hits them; \"keyed\" ones follow their keys, whatever is in their way. With "
             "method \"scree\" two of them carry by friction what both overlap by half a per cent "
             "to two of its size; more, and it is pushed out."},
    {.path = "body.position",
     .type = numbers,
     .unit = "shot's unit of length",
     .byDefault = "[0.0, 0.0, 0.0]",
     .excludes = "plane|poses|keys",
     .help = "Where the asset's own origin stands at the first frame."},
    {.path = "body.rotation",
     .type = numbers,
     .unit = "degrees",
     .byDefault = "[0.0, 0.0, 0.0]",
     .min = -360000,
     .max = 360000,
     .excludes = "orientation|plane|poses|keys",
     .help = "Angles about the world's x, then y, then z axis: R = Rz Ry Rx."},
    {.path = "body.orientation",
     .type = numbers,
     .count = 4,
     .excludes = "rotation|plane|poses|keys",
     .help = "Rotation as a quaternion [w, x, y, z], instead of rotation; it is normalised."},
    {.path = "body.velocity",
     .type = numbers,
     .unit = "shot's unit of length per second",
     .byDefault = "[0.0, 0.0, 0.0]",
     .excludes = "plane|keys",
     .help = "Of the centre of mass at the first frame. Fast thin bodies need many sub-steps."},
    {.path = "body.spin",
     .type = numbers,
     .unit = "degrees/s",
     .byDefault = "[0.0, 0.0, 0.0]",
     .excludes = "plane|keys",
     .help = "Angular velocity about the world's axes at the first frame."},
    {.path = "body.mass",
     .unit = "kg",
     .min = 0,
     .isOpen = true,
     .excludes = "plane",
     .help = "Instead of density times volume."},
    {.path = "body.grid",
     .type = table,
     .excludes = "plane|poses|keys",
     .help = "Copies in rows about the position, which is the middle of the block; they are named "
             "NAME_0000, NAME_0001, … with x running fastest, then y, then z."},
    {.path = "body.grid.count",
     .type = integers,
     .min = 1,
     .max = 1000000,
     .isRequired = true,
     .help = "Copies along x, y and z; at most a million in all."},
    {.path = "body.grid.spacing",
     .type = numbers,
     .unit = "shot's unit of length",
     .isRequired = true,
     .help = "From copy to copy along x, y and z, to both sides of the position: of three copies "
             "the middle one stands on it, of two none does. Less than the size of the body and "
             "they start inside each other."},
    {.path = "body.poses",
     .type = text,
     .isFile = true,
     .excludes = "plane|position|rotation|orientation|grid|keys",
     .help = "Text file, relative to the shot, with a line \"x y z qw qx qy qz\" for each copy; "
             "they are named NAME_0000, NAME_0001, …. What follows # is a comment."},
    {.path = "body.force",
     .type = numbers,
     .unit = "N",
     .excludes = "plane",
     .help = "Constant force at the centre of mass, along the world's axes, whatever the unit of "
             "length. Small against weight it is hardly seen: one newton is the weight of 0.1 kg."},
    {.path = "body.torque",
     .type = numbers,
     .unit = "N m",
     .excludes = "plane",
     .help = "Constant torque about the world's axes. Nothing but contact brakes a free body: it "
             "spins faster and faster, and fast spin costs sub-steps."},
    {.path = "body.group",
     .type = text,
     .help = "Name of the group this body is in, for collides and unmoved_by of any body, and for "
             "groups of a force."},
    {.path = "body.collides",
     .type = words,
     .help = "Groups this body collides with; without it, all bodies. Both of a pair must accept "
             "the other. An empty list passes through everything, the ground too."},
    {.path = "body.unmoved_by",
     .type = words,
     .help = "Groups that cannot move this body although it moves them, as if it were infinitely "
             "heavy: debris that must not push the hero. Momentum is not kept between the two."},
    {.path = "body.start",
     .type = word,
     .byDefault = "\"awake\"",
     .choices = "awake|asleep",
     .excludes = "plane",
     .help =
         "\"asleep\" bodies stay where they are, whatever they stand on, and cost nothing until "
         "something is about to touch them, a force on them changes, or what has keys moves from "
         "under them; all that touches them, and "
         "sleeps too, wakes with them. For walls and dominoes that wait for their blow. Method "
         "\"scree\" only."},
    {.path = "body.visible",
     .type = boolean,
     .help = "false for what others collide with and nobody is to see, such as a proxy of a "
             "character or a wall in front of the camera: it is left out of pictures and of "
             "sequences of meshes, and hidden in caches. True without this key."},
    {.path = "body.keys",
     .type = tableList,
     .excludes = "plane|position|rotation|orientation|velocity|spin|grid|poses",
     .help =
         "Poses of keyed motion in order of time: keys = [{ frame = 1001, position = [0, 1, 0] "
         "}, { frame = 1060.5, position = [4, 1, 0], rotation = [0, 90, 0] }]. Before the first "
         "and after the last the body stands still."},
    {.path = "body.keys.frame",
     .unit = "frames",
     .min = -1000000000,
     .max = 1000000000,
     .isRequired = true,
     .help = "When; between frames is allowed. Frames before the shot's first are too."},
    {.path = "body.keys.position",
     .type = numbers,
     .unit = "shot's unit of length",
     .isRequired = true,
     .help =
         "Where the asset's own origin is. Fast motion costs sub-steps while anything is near."},
    {.path = "body.keys.rotation",
     .type = numbers,
     .unit = "degrees",
     .min = -360000,
     .max = 360000,
     .excludes = "orientation",
     .help = "As body.rotation. From key to key the body turns by the shorter way, so that a full "
             "turn takes three keys or more."},
    {.path = "body.keys.orientation",
     .type = numbers,
     .count = 4,
     .excludes = "rotation",
     .help = "Rotation as a quaternion [w, x, y, z], instead of rotation; it is normalised."},
    {.path = "body.interpolate",
     .type = word,
     .choices = "smooth|linear",
     .help = "How keyed motion goes from key to key. \"smooth\", which is taken without this key, "
             "starts and ends at rest, passes keys without a kink and never overshoots; \"linear\" "
             "has constant speed from key to key, and its jumps of speed kick what it carries."},
    {.path = "body.release",
     .type = integer,
     .unit = "frame",
     .min = -1000000000,
     .max = 1000000000,
     .help =
         "Frame at which a keyed body becomes dynamic, with the velocity it has just then: that is "
         "none at or after the last key of smooth motion, which ends at rest there, and of "
         "linear motion at the last key that of its last stretch, after it none. What is thrown "
         "has a key after its release, or linear motion."},
    {.path = "body.keyed_from",
     .type = integer,
     .unit = "frame",
     .min = -1000000000,
     .max = 1000000000,
     .help =
         "Frame at which the keys take a body over. Until then it is dynamic and starts, at "
         "rest, at the first of its keys. The picture of this frame is the last that shows where "
         "it has got to; from there on it stands on its keys, however far they are."},
};

const std::vector<ShotKey> kForceKeys = {
    {.path = "force",
     .type = tableList,
     .help = "Fields of force that fill space, each [[force]] one of them. They act on the centres "
             "of mass of dynamic bodies and turn nothing."},
    {.path = "force.name", .type = text, .help = "What it is called in reports."},
    {.path = "force.type",
     .type = word,
     .choices = "wind|radial|vortex|uniform",
     .isRequired = true,
     .help = "\"wind\" drags bodies along with moving air; \"radial\" pushes away from its center, "
             "or pulls with a strength below 0; \"vortex\" drives around the axis through center; "
             "\"uniform\" pushes in one direction, as gravity does."},
    {.path = "force.strength",
     .unit = "m/s²; of wind: shot's unit of length per second",
     .excludes = "keys",
     .help = "Acceleration, the same for light and heavy bodies; of a wind the speed of the "
             "air. Gravity is 9.81: less hardly lifts anything."},
    {.path = "force.keys",
     .type = tableList,
     .help = "Strength that changes: keys = [{ frame = 1001, strength = 0 }, { frame = 1024, "
             "strength = 20 }]; straight from key to key, held before and after."},
    {.path = "force.keys.frame",
     .unit = "frames",
     .min = -1000000000,
     .max = 1000000000,
     .isRequired = true,
     .help = "When; between frames is allowed."},
    {.path = "force.keys.strength", .isRequired = true, .help = "As force.strength."},
    {.path = "force.direction",
     .type = numbers,
     .help = "Of a wind or a uniform force, or of a vortex's axis: with the thumb along it, the "
             "fingers of the "
             "right hand show the sense. Any length but zero."},
    {.path = "force.center",
     .type = numbers,
     .unit = "shot's unit of length",
     .byDefault = "[0.0, 0.0, 0.0]",
     .help = "Where a radial force comes from, what a vortex's axis passes through, where a wind "
             "or a uniform force with a falloff is strongest."},
    {.path = "force.falloff",
     .type = word,
     .byDefault = "\"none\"",
     .choices = "none|linear|smooth|inverse_square",
     .help = "How strength fades with distance from the center, of a vortex from its axis: "
             "\"linear\" and \"smooth\" end at reach, \"inverse_square\" is halved there and "
             "felt everywhere."},
    {.path = "force.reach",
     .unit = "shot's unit of length",
     .min = 0,
     .isOpen = true,
     .help = "The distance that falloff speaks of."},
    {.path = "force.drag",
     .min = 0,
     .max = kInfinity,
     .help = "Drag coefficient of bodies in a wind, on a quarter of their surface, which is what a "
             "convex body shows on average; 1 when left out. Large values make light bodies move "
             "with the air at once."},
    {.path = "force.groups",
     .type = words,
     .help = "Groups, as of body.group, that it acts on, like [\"leaves\"]. All bodies when left "
             "out."},
};

const std::vector<ShotKey> kPairKeys = {
    {.path = "pair",
     .type = tableList,
     .help = "Friction and restitution of two materials against each other, instead of what "
             "solver.combine makes of them."},
    {.path = "pair.of",
     .type = words,
     .isRequired = true,
     .help = "The two materials, in any order; twice the same for a material against itself."},
    {.path = "pair.friction",
     .min = 0,
     .max = kInfinity,
     .help = "As material.friction, for this pair."},
    {.path = "pair.restitution",
     .min = 0,
     .max = 1,
     .help = "As material.restitution, for this pair."},
};

const std::vector<ShotKey> kImportKeys = {
    {.path = "import",
     .type = tableList,
     .help =
         "Many bodies from one file, each [[import]] one for every node that shows a mesh, where "
         "it stands and under its own name."},
    {.path = "import.file",
     .type = text,
     .isFile = true,
     .isRequired = true,
     .help = "obj, ply, stl, glb, gltf, fbx or abc, relative to the shot file. glTF is in metres "
             "and FBX says its unit; the lengths of others are the shot's. Up is +y in glTF and "
             "Alembic; others are taken for the shot's, and an FBX that says otherwise is warned "
             "of."},
    {.path = "import.nodes",
     .type = textOrTexts,
     .byDefault = "\"*\"",
     .help =
         "Names of nodes with * and ? for what may be anything: [\"Mug*\", \"Bowl_?\"]. A pattern "
         "that fits no node is an error. Nodes of an OBJ file are its objects (o), the second of a "
         "name called NAME.001, or its groups (g) where it has no two objects."},
    {.path = "import.position",
     .type = numbers,
     .unit = "shot's unit of length",
     .help = "Where the file's origin stands; without it, at that of the shot. The whole import is "
             "moved, turned and scaled as if it hung on an empty: all bodies, and the motion of "
             "keyed ones. A camera of the same file takes the same keys in its [[camera]]."},
    {.path = "import.rotation",
     .type = numbers,
     .unit = "degrees",
     .min = -360000,
     .max = 360000,
     .excludes = "orientation",
     .help = "As body.rotation, of the whole import about the file's origin."},
    {.path = "import.orientation",
     .type = numbers,
     .count = 4,
     .excludes = "rotation",
     .help = "Rotation as a quaternion [w, x, y, z], instead of rotation; it is normalised."},
    {.path = "import.scale",
     .min = 0,
     .isOpen = true,
     .help = "Factor of the whole import, of places and sizes alike, about the file's origin: 0.01 "
             "brings an OBJ in centimetres into a shot in metres. It is baked into the meshes."},
    {.path = "import.motion",
     .type = word,
     .byDefault = "\"dynamic\"",
     .choices = "dynamic|static|keyed",
     .help =
         "\"dynamic\" bodies are moved by gravity and impulses; \"static\" ones never move; "
         "\"keyed\" ones play the file's own animation, steadily from sample to sample. The time "
         "zero of glTF and FBX is the shot's first frame; that of Alembic is frame 0."},
    {.path = "import.interpolate",
     .type = word,
     .choices = "smooth|linear",
     .help = "How keyed motion goes from sample to sample. \"linear\", which is taken without this "
             "key, shows what other programs show between samples; \"smooth\" has no jumps of "
             "speed, for motion that carries bodies, and goes its own way between the file's keys: "
             "what hangs on a node that turns needs one every few degrees."},
    {.path = "import.offset",
     .unit = "frames",
     .min = -1000000000,
     .max = 1000000000,
     .help = "How much later than in the file keyed motion comes; negative: sooner. A shot that "
             "begins ten frames earlier, for a heap to settle, has its animation 10 later. A "
             "camera of the same file takes the same key in its [[camera]]."},
    {.path = "import.keyed_from",
     .type = integer,
     .unit = "frame",
     .min = -1000000000,
     .max = 1000000000,
     .help = "As body.keyed_from, of all bodies of a keyed import."},
    {.path = "import.release",
     .type = integer,
     .unit = "frame",
     .min = -1000000000,
     .max = 1000000000,
     .help = "As body.release, of all bodies of a keyed import: pieces that are animated first "
             "and fly on from there."},
    {.path = "import.start",
     .type = word,
     .byDefault = "\"awake\"",
     .choices = "awake|asleep",
     .help = "As body.start, of all dynamic bodies of the import."},
    {.path = "import.material",
     .type = text,
     .isRequired = true,
     .help = "Name of a [material.NAME]."},
    {.path = "import.visible",
     .type = boolean,
     .help = "As body.visible, of all bodies of the import."},
    {.path = "import.velocity",
     .type = numbers,
     .unit = "shot's unit of length per second",
     .help = "Of all dynamic bodies of the import at the first frame, along the world's axes."},
    {.path = "import.group", .type = text, .help = "As body.group, of all bodies of the import."},
    {.path = "import.collides",
     .type = words,
     .help = "As body.collides, of all bodies of the import."},
    {.path = "import.unmoved_by",
     .type = words,
     .help = "As body.unmoved_by, of all bodies of the import."},
    {.path = "import.sdf",
     .type = table,
     .help = "As shape.sdf, for each shape of the import. With method \"paper\" many large thin "
             "pieces, such as those of a broken vase, take a field of up to tens of megabytes each "
             "unless it is made coarser here; `scree check` tells."},
    {.path = "import.sdf.resolution",
     .type = integer,
     .unit = "voxels",
     .min = 8,
     .max = 512,
     .excludes = "voxel",
     .help = "As shape.sdf.resolution: the same for large pieces and small ones."},
    {.path = "import.sdf.voxel",
     .unit = "shot's unit of length",
     .min = 0,
     .isOpen = true,
     .excludes = "resolution",
     .help = "As shape.sdf.voxel: large pieces get more of them than small ones."},
    {.path = "import.sdf.storage",
     .type = word,
     .byDefault = "\"auto\"",
     .choices = "auto|dense|bricks",
     .help = "As shape.sdf.storage."},
    {.path = "import.field",
     .type = word,
     .choices = "refined|grid",
     .help = "As shape.field; \"refined\" without this key."},
    {.path = "import.normals",
     .type = word,
     .choices = "auto|smooth|true",
     .help = "As shape.normals; \"auto\" without this key."},
    {.path = "import.edge_samples", .type = boolean, .help = "As shape.edge_samples."},
    {.path = "import.mesh",
     .type = table,
     .help = "As shape.mesh, for each shape of the import. An [[import]] of its own serves nodes "
             "that need what others do not."},
    {.path = "import.mesh.repair",
     .type = word,
     .byDefault = "\"none\"",
     .choices = "none|wrap|shell|ground|room|solidify",
     .help = "As shape.mesh.repair."},
    {.path = "import.mesh.thickness",
     .unit = "shot's unit of length",
     .min = 0,
     .isOpen = true,
     .help = "As shape.mesh.thickness."},
};

const std::vector<ShotKey> kEmitterKeys = {
    {.path = "emitter",
     .type = tableList,
     .help = "Bodies that come while the shot runs, each [[emitter]] a number of them, named "
             "NAME_0000, NAME_0001, … Every draw depends on the seed, the emitter's name and the "
             "number of the body alone."},
    {.path = "emitter.name",
     .type = text,
     .isRequired = true,
     .help = "Identifier (letters, digits, _; no digit first); its bodies are NAME_0000, …"},
    {.path = "emitter.shape",
     .type = textOrTexts,
     .isRequired = true,
     .help = "Name of a [shape.NAME], or a list of them, from which each body draws one."},
    {.path = "emitter.weights",
     .type = numbers,
     .count = 0,
     .min = 0,
     .isOpen = true,
     .help = "How often each shape of the list is drawn, against the others. Without weights all "
             "are drawn equally often."},
    {.path = "emitter.material",
     .type = text,
     .isRequired = true,
     .help = "Name of a [material.NAME]."},
    {.path = "emitter.count",
     .type = integer,
     .min = 1,
     .max = 1000000,
     .isRequired = true,
     .help = "Bodies in all, exactly."},
    {.path = "emitter.frames",
     .type = text,
     .unit = "frames",
     .help =
         "\"FIRST-LAST\": births are spread evenly over these frames, or all at once if it is "
         "one frame. Without it, at the first frame of the shot. A body is seen at the frame of "
         "its birth where it begins, and moves from then on."},
    {.path = "emitter.box",
     .type = table,
     .excludes = "layout|poses",
     .help = "Bodies begin at places drawn in this box."},
    {.path = "emitter.box.min",
     .type = numbers,
     .unit = "shot's unit of length",
     .isRequired = true,
     .help = "Lowest place of the asset's origin along x, y and z."},
    {.path = "emitter.box.max",
     .type = numbers,
     .unit = "shot's unit of length",
     .isRequired = true,
     .help = "Highest place of the asset's origin along x, y and z."},
    {.path = "emitter.layout",
     .type = table,
     .excludes = "box|poses",
     .help = "Bodies begin on a grid: place after place, and again from its beginning."},
    {.path = "emitter.layout.position",
     .type = numbers,
     .unit = "shot's unit of length",
     .byDefault = "[0.0, 0.0, 0.0]",
     .help = "The middle of the grid."},
    {.path = "emitter.layout.grid",
     .type = table,
     .isRequired = true,
     .help = "Places in rows about layout.position, which is the middle of the block, x running "
             "fastest, then y, then z."},
    {.path = "emitter.layout.grid.count",
     .type = integers,
     .min = 1,
     .max = 1000000,
     .isRequired = true,
     .help = "Places along x, y and z; at most a million in all."},
    {.path = "emitter.layout.grid.spacing",
     .type = numbers,
     .unit = "shot's unit of length",
     .isRequired = true,
     .help = "From place to place along x, y and z."},
    {.path = "emitter.poses",
     .type = text,
     .isFile = true,
     .excludes = "box|layout|tilt",
     .help = "Text file, relative to the shot, with a line \"x y z qw qx qy qz\" for each place: "
             "place after place, and again from its beginning."},
    {.path = "emitter.tilt",
     .type = numberOrWord,
     .unit = "degrees",
     .byDefault = "0.0",
     .min = 0,
     .max = 180,
     .choices = "random",
     .help = "How bodies are turned at birth: \"random\" is any orientation, all alike likely; a "
             "number the largest angle by which they lean from upright, in a drawn direction."},
    {.path = "emitter.velocity",
     .type = numbers,
     .unit = "shot's unit of length per second",
     .byDefault = "[0.0, 0.0, 0.0]",
     .help = "Of the centre of mass at birth. Slow ones have not left their place when the next "
             "are due there."},
    {.path = "emitter.spin",
     .type = numbers,
     .unit = "degrees/s",
     .byDefault = "[0.0, 0.0, 0.0]",
     .help = "Angular velocity about the world's axes at birth."},
    {.path = "emitter.clear",
     .type = word,
     .byDefault = "\"wait\"",
     .choices = "wait|skip|fail",
     .help = "While another body stands in a body's place: \"wait\" tries again at every frame, "
             "\"skip\" leaves the body out, \"fail\" ends the run. Those that never came are "
             "counted when the shot ends."},
    {.path = "emitter.group", .type = text, .help = "As body.group, of all bodies of the emitter."},
    {.path = "emitter.collides",
     .type = words,
     .help = "As body.collides, of all bodies of the emitter."},
    {.path = "emitter.unmoved_by",
     .type = words,
     .help = "As body.unmoved_by, of all bodies of the emitter."},
};

}  // namespace

void appendWorldKeys(std::vector<ShotKey>& keys)
{
    for (const auto* part : {&kBodyKeys, &kForceKeys, &kPairKeys, &kImportKeys, &kEmitterKeys}) {
        keys.insert(keys.end(), part->begin(), part->end());
    }
}

}  // namespace scree
