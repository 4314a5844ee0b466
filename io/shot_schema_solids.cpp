// The keys of [material.NAME] and [shape.NAME]: what bodies are made of.
#include "io/shot_schema_keys.h"

namespace scree {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using enum KeyType;

const std::vector<ShotKey> kMaterialKeys = {
    {.path = "material",
     .type = namedTables,
     .help = "How surfaces behave and look: one table [material.NAME] for each. Where two bodies "
             "touch, restitution is the smaller and friction the larger of both."},
    {.path = "material.density",
     .unit = "kg/m³",
     .byDefault = "1000.0",
     .min = 0,
     .isOpen = true,
     .help = "Mass by volume. Only ratios matter to what one sees: one body a thousand times "
             "heavier than what carries it is hard for any solver."},
    {.path = "material.friction",
     .byDefault = "0.5",
     .min = 0,
     .max = kInfinity,
     .help = "Coulomb coefficient; a block starts to slide on a slope of atan(friction). A pair "
             "takes the larger of its two, so a slippery body on a rough floor is rough. 0 never "
             "holds; above 2 things look glued."},
    {.path = "material.restitution",
     .byDefault = "0.0",
     .min = 0,
     .max = 1,
     .help = "Part of the approach speed that a collision gives back; a pair takes the smaller of "
             "its two. 0 lands dead, 1 bounces for ever."},
    {.path = "material.rolling_friction",
     .unit = "shot's unit of length",
     .byDefault = "0.0",
     .min = 0,
     .max = kInfinity,
     .excludes = "rolling_friction_raw",
     .help = "Lever arm of the torque that brakes rolling where bodies stick: arm times the force "
             "between them. A thousandth of the radius suits a hard wheel, a hundredth a tyre; a "
             "pair takes the larger of its two. 0 rolls for ever, an arm near the radius never "
             "starts. That is of what is round, as a ball, a wheel or a coin; of other things flat "
             "contacts resist up to ten times more, edges down to a tenth."},
    {.path = "material.rolling_friction_raw",
     .unit = "1/(kg m)",
     .min = 0,
     .max = kInfinity,
     .excludes = "rolling_friction",
     .help = "Instead of rolling_friction, the paper's own coefficient: spin taken away by normal "
             "impulse, whatever the inertia. Light bodies stop at once where heavy ones roll on."},
    {.path = "material.spinning_friction",
     .unit = "shot's unit of length",
     .byDefault = "0.0",
     .min = 0,
     .max = kInfinity,
     .excludes = "spinning_friction_raw",
     .help = "Lever arm of the torque that brakes spinning on the spot, like rolling_friction; "
             "about two thirds of the radius of the patch that touches, times friction. 0 lets a "
             "ball spin for ever."},
    {.path = "material.spinning_friction_raw",
     .unit = "1/(kg m)",
     .min = 0,
     .max = kInfinity,
     .excludes = "spinning_friction",
     .help = "Instead of spinning_friction, the paper's own coefficient, like "
             "rolling_friction_raw."},
    {.path = "material.color",
     .type = numbers,
     .unit = "linear light",
     .byDefault = "[0.6, 0.6, 0.6]",
     .min = 0,
     .max = 1,
     .help = "Red, green and blue of previews. Looks only."},
    {.path = "material.roughness",
     .byDefault = "0.5",
     .min = 0,
     .max = 1,
     .help = "0 is a mirror-like highlight, 1 is chalk. Looks only."},
};

const std::vector<ShotKey> kShapeKeys = {
    {.path = "shape",
     .type = namedTables,
     .help =
         "Solids that bodies share: one table [shape.NAME] for each, with exactly one of torus, "
         "box, sphere, cylinder, capsule or file."},
    {.path = "shape.torus",
     .type = table,
     .excludes = "box|sphere|cylinder|capsule|file",
     .help = "Ring about +y."},
    {.path = "shape.torus.major",
     .unit = "shot's unit of length",
     .byDefault = "1.0",
     .min = 0,
     .isOpen = true,
     .help = "From the centre of the ring to the middle of its tube."},
    {.path = "shape.torus.minor",
     .unit = "shot's unit of length",
     .byDefault = "0.25",
     .min = 0,
     .isOpen = true,
     .help = "Radius of the tube; less than major, or the hole closes."},
    {.path = "shape.torus.segments",
     .type = integers,
     .count = 2,
     .byDefault = "[16, 10]",
     .min = 3,
     .max = 1024,
     .help = "Cross sections around the ring and points on each. What is drawn is what collides: "
             "fewer than 18 sections roll like a polygon, more like a circle."},
    {.path = "shape.box",
     .type = table,
     .excludes = "torus|sphere|cylinder|capsule|file",
     .help = "Box centred at its origin."},
    {.path = "shape.box.size",
     .type = numbers,
     .unit = "shot's unit of length",
     .byDefault = "[1.0, 1.0, 1.0]",
     .min = 0,
     .isOpen = true,
     .help = "Edges along x, y and z."},
    {.path = "shape.box.segments",
     .type = integers,
     .byDefault = "[2, 2, 2]",
     .min = 1,
     .max = 512,
     .help = "Squares along each edge. Method \"paper\" tests the points of the mesh against other "
             "bodies: its boxes of one segment, stacked with their edges aligned, do not stand."},
    {.path = "shape.sphere",
     .type = table,
     .excludes = "torus|box|cylinder|capsule|file",
     .help = "Sphere from a subdivided icosahedron."},
    {.path = "shape.sphere.radius",
     .unit = "shot's unit of length",
     .byDefault = "0.5",
     .min = 0,
     .isOpen = true,
     .help = "All points of the mesh lie at this distance from the origin."},
    {.path = "shape.sphere.subdivisions",
     .type = integer,
     .byDefault = "3",
     .min = 0,
     .max = 8,
     .help = "Each one makes four triangles of one; 3 gives 1280. From 2 on method \"scree\" "
             "touches with the ball that the mesh stands for; coarser ones roll unevenly."},
    {.path = "shape.cylinder",
     .type = table,
     .excludes = "torus|box|sphere|capsule|file",
     .help = "Prism about +y, origin at its centre."},
    {.path = "shape.cylinder.radius",
     .unit = "shot's unit of length",
     .byDefault = "0.5",
     .min = 0,
     .isOpen = true,
     .help = "From the axis to the edges of the prism; its sides lie a little inside."},
    {.path = "shape.cylinder.height",
     .unit = "shot's unit of length",
     .byDefault = "1.0",
     .min = 0,
     .isOpen = true,
     .help = "From end to end."},
    {.path = "shape.cylinder.sectors",
     .type = integer,
     .byDefault = "20",
     .min = 3,
     .max = 4096,
     .help = "Sides of the prism."},
    {.path = "shape.cylinder.bands",
     .type = integer,
     .byDefault = "1",
     .min = 1,
     .max = 4096,
     .help =
         "Rows of points along the height. With method \"paper\", which tests the points of the "
         "mesh, long sides without any can be pierced by thin bodies."},
    {.path = "shape.capsule",
     .type = table,
     .excludes = "torus|box|sphere|cylinder|file",
     .help = "Cylinder about +y between two half spheres."},
    {.path = "shape.capsule.radius",
     .unit = "shot's unit of length",
     .byDefault = "0.25",
     .min = 0,
     .isOpen = true,
     .help = "Of the cylinder and its round ends."},
    {.path = "shape.capsule.height",
     .unit = "shot's unit of length",
     .byDefault = "1.0",
     .min = 0,
     .isOpen = true,
     .help = "Of the cylinder between the centres of the ends."},
    {.path = "shape.capsule.sectors",
     .type = integer,
     .byDefault = "20",
     .min = 3,
     .max = 4096,
     .help =
         "Sides around the axis. From 18 on, with 5 rings or more, method \"scree\" lets it touch "
         "capsules, balls and planes as the round solid that it stands for, which is faster too; "
         "coarser ones do so as what they are."},
    {.path = "shape.capsule.rings",
     .type = integer,
     .byDefault = "5",
     .min = 1,
     .max = 1024,
     .help = "Bands on each half sphere."},
    {.path = "shape.file",
     .type = text,
     .isFile = true,
     .excludes = "torus|box|sphere|cylinder|capsule",
     .help = "Mesh to read (obj, ply, stl, glb, gltf, fbx or abc), relative to the shot file; all "
             "its nodes "
             "as one. glTF is in metres and FBX says its unit. It must be the closed, "
             "outward surface of a solid; what is wrong with it is said with its place."},
    {.path = "shape.scale",
     .type = numberOrList,
     .byDefault = "1.0",
     .min = 0,
     .isOpen = true,
     .help = "Factor, or one for each axis, baked into the mesh before anything is computed."},
    {.path = "shape.sdf",
     .type = table,
     .help =
         "How finely the distance field is sampled. Without it, the thinnest part gets twelve "
         "voxels and the longest edge at least 48. With method \"scree\" and a refined field, "
         "whose contacts are those of the mesh itself, it takes no more than a million voxels in "
         "all, however thin the parts are; without these more than 512 along the longest edge "
         "are refused."},
    {.path = "shape.sdf.resolution",
     .type = integer,
     .unit = "voxels",
     .min = 8,
     .max = 512,
     .excludes = "voxel",
     .help = "Voxels along the longest edge of the box. Few lose thin parts; memory grows with the "
             "cube."},
    {.path = "shape.sdf.voxel",
     .unit = "shot's unit of length",
     .min = 0,
     .isOpen = true,
     .excludes = "resolution",
     .help = "Edge of a voxel, instead of resolution."},
    {.path = "shape.sdf.storage",
     .type = word,
     .byDefault = "\"auto\"",
     .choices = "auto|dense|bricks",
     .help = "How the field is kept: \"dense\" holds every node and answers fastest, \"bricks\" "
             "only blocks near the surface, for large fields. \"auto\" takes bricks above 2 MiB "
             "where they save a quarter. Near the surface both say the same to the last bit."},
    {.path = "shape.field",
     .type = word,
     .byDefault = "\"refined\"",
     .choices = "refined|grid",
     .help = "What decides inside and depth near the surface: \"refined\" asks the mesh, \"grid\" "
             "the sampled field alone, as in the paper, which rounds edges by millimetres and lets "
             "stacks of cubes slip."},
    {.path = "shape.normals",
     .type = word,
     .byDefault = "\"auto\"",
     .choices = "auto|smooth|true",
     .help =
         "Where contact normals come from: \"smooth\" is the gradient of the field, \"true\" the "
         "mesh's own faces, \"auto\" takes true when an edge is sharper than 40 degrees."},
    {.path = "shape.edge_samples",
     .type = boolean,
     .help = "Whether edges are tested besides points. By default when edges are long against the "
             "thickness. Off, crossed planks fall through each other."},
    {.path = "shape.mesh",
     .type = table,
     .help = "What to do with a mesh that is no solid. Equal points, triangles without area and a "
             "mesh that is wholly inside-out are always put right, and told; anything else only "
             "as this says."},
    {.path = "shape.mesh.repair",
     .type = word,
     .byDefault = "\"none\"",
     .choices = "none|wrap|shell|ground|room|solidify",
     .help =
         "\"none\" refuses holes, sheets and parts that pierce each other. \"wrap\" collides as "
         "the solid around which the mesh winds: closes holes, joins parts, rounds edges by "
         "about a voxel (sdf says how fine, else 64 along the longest edge). \"shell\" gives "
         "the mesh a thickness, for leaves and open bowls. `scree check` says how far what "
         "collides then is from what is drawn. \"ground\" closes an open sheet that is seen from "
         "one side, such as a terrain, by walls down from its rim and a floor: bodies touch "
         "exactly what is drawn, and what its faces look away from is solid. \"room\" puts walls "
         "around a closed mesh that is seen from inside: bodies within touch exactly what is "
         "drawn. Without it such a mesh is turned, and full. \"solidify\" puts a thickness behind "
         "the faces of an open sheet that folds, such as the floor and the walls of a stage: "
         "bodies in front touch exactly what is drawn."},
    {.path = "shape.mesh.thickness",
     .unit = "shot's unit of length",
     .min = 0,
     .isOpen = true,
     .help =
         "Of the shell, half of it on either side of the mesh. Thin shells need small time "
         "steps and fine fields. Of the ground, from its lowest point down to its floor, and "
         "of the walls of the room at their thinnest; of these by default a tenth of the longest "
         "edge. Of what is solidified, behind its faces."},
    {.path = "shape.collision",
     .type = table,
     .help = "A mesh of its own for collisions: mass, contacts and all that is said of the solid "
             "come from it, pictures and caches show the shape itself, which then may be open. "
             "`scree check` says how far the two are apart, and where."},
    {.path = "shape.collision.file",
     .type = text,
     .isFile = true,
     .isRequired = true,
     .help =
         "Mesh that collides (obj, ply, stl, glb, gltf, fbx or abc), relative to the shot file, "
         "in the same axes and with the same scale as the shape. mesh, sdf, field, normals and "
         "edge_samples speak of it."},
    {.path = "shape.collide",
     .type = word,
     .byDefault = "\"mesh\"",
     .choices = "mesh|exact",
     .help = "Whether a generated sphere, box or cylinder collides as its mesh, which is what is "
             "drawn, or as its exact solid: true roundness and the solid's own mass, but few "
             "segments then show gaps, since the mesh lies inside. Of a cylinder method \"scree\" "
             "takes the mass alone: it touches with its mesh, and rolls as round as that does."},
};

}  // namespace

void appendSolidsKeys(std::vector<ShotKey>& keys)
{
    for (const auto* part : {&kMaterialKeys, &kShapeKeys}) {
        keys.insert(keys.end(), part->begin(), part->end());
    }
}

}  // namespace scree
