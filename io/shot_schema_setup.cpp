// The keys at the top of a shot file: itself, [shot], [solver], [start].
#include "io/shot_schema_keys.h"

namespace scree {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using enum KeyType;

const std::vector<ShotKey> kFileKeys = {
    {.path = "scree",
     .type = integer,
     .unit = "format version",
     .min = 1,
     .max = 1,
     .isRequired = true,
     .help = "Version of the shot format. A program that does not know a version refuses the file "
             "instead of guessing."},
    {.path = "extends",
     .type = text,
     .isFile = true,
     .help = "Another shot file, relative to this one, whose keys hold wherever this one says "
             "nothing. Of bodies, emitters and cameras those of one name are taken together key by "
             "key; "
             "others are added, as are forces, pairs and imports. Any other list, such as "
             "output.export, is replaced as a whole."},
};

const std::vector<ShotKey> kShotKeys = {
    {.path = "shot",
     .type = table,
     .isRequired = true,
     .help = "Name, time and space of the shot."},
    {.path = "shot.name",
     .type = text,
     .isRequired = true,
     .help = "Identifier of the shot (letters, digits, _; no digit first): the top object of every "
             "export and the name of the take."},
    {.path = "shot.frames",
     .type = text,
     .unit = "frames",
     .byDefault = "\"1001-1240\"",
     .help = "First and last frame, \"1001-1240\". The first one is simulated time zero and shows "
             "the bodies where the shot puts them."},
    {.path = "shot.fps",
     .unit = "frames/s",
     .byDefault = "24.0",
     .min = 0,
     .max = 10000,
     .isOpen = true,
     .help = "Frames per second: when a picture is taken. How finely time is simulated follows "
             "from the motion (see solver.substeps)."},
    {.path = "shot.units",
     .type = word,
     .byDefault = "\"m\"",
     .choices = "m|cm|mm|in|ft",
     .help =
         "Unit of every length in the shot and its assets. Gravity and density stay in m/s² and "
         "kg/m³. A scene modelled in centimetres but read as metres falls ten times too "
         "slowly: that floating look is nearly always this key."},
    {.path = "shot.up",
     .type = word,
     .byDefault = "\"+y\"",
     .choices = "+y|+z",
     .help = "Which axis points up. It turns the default gravity and is told to exports; nothing "
             "else is rotated."},
    {.path = "shot.gravity",
     .type = numbers,
     .unit = "m/s²",
     .byDefault = "[0.0, -9.81, 0.0]",
     .help = "Acceleration of free fall, in m/s² whatever the unit of length. With up = \"+z\" the "
             "default is [0, 0, -9.81]. With [0, 0, 0] bodies only drift and collide."},
    {.path = "shot.seed",
     .type = integer,
     .byDefault = "1",
     .min = 0,
     .help =
         "Every draw derives from this number and the name of what it is for. Another seed gives "
         "another, equally valid heap; the same seed gives the same bits."},
};

const std::vector<ShotKey> kSolverKeys = {
    {.path = "solver",
     .type = table,
     .byDefault = "{}",
     .help = "How hard each phase of a time step works. The defaults stack without tuning; raise a "
             "number when the report says that a loop hit its cap."},
    {.path = "solver.method",
     .type = word,
     .byDefault = "\"scree\"",
     .choices = "scree|paper",
     .help =
         "The way contacts are resolved. \"scree\" knows contacts before they touch and "
         "remembers what held them: heaps lie still, and it is many times faster. \"paper\" "
         "follows Guendelman, Bridson and Fedkiw; it is the reference, and solver.strict leaves "
         "out what has been repaired in it."},
    {.path = "solver.sleep",
     .type = boolean,
     .byDefault = "true",
     .method = "scree",
     .help = "A body that lies still and balanced, held up by nothing awake, falls asleep: no "
             "motion at all, and no cost. It wakes when it is struck, when its load no longer "
             "balances, when a force on it changes or what has keys moves beside it. What rocks "
             "in its place for some seconds and goes nowhere is calmed, so that it does not keep "
             "a heap awake; what rocks wider, as bowls do, later. What hangs may swing."},
    {.path = "solver.contact_sweeps",
     .type = integer,
     .unit = "sweeps",
     .byDefault = "12",
     .min = 1,
     .max = 10000,
     .method = "scree",
     .help =
         "Sweeps over the contacts of a large heap while it moves; small ones are solved to the "
         "end anyway, at rest in up to 4000, and large ones get up to a hundred once they settle, "
         "up to 400 where fewer leave forces that drive the heap, as in a wall that rocks, and up "
         "to 4000 in the first step of a new heap. Too few and the heap sinks into itself before "
         "it comes to rest."},
    {.path = "solver.collision_iterations",
     .type = integer,
     .unit = "sweeps",
     .byDefault = "5",
     .min = 0,
     .max = 1000,
     .help = "Sweeps over colliding pairs at the predicted positions; method \"scree\" ends when "
             "nothing is hit any more, after twenty times as many at most. Too few and fast heaps "
             "overlap; 0 switches bouncing off."},
    {.path = "solver.collision_pair_impulses",
     .type = integer,
     .unit = "impulses",
     .byDefault = "20",
     .min = 1,
     .max = 10000,
     .help = "Impulses a colliding pair may receive in one visit. With 1 a flat landing turns into "
             "a tumble, because only one corner is answered."},
    {.path = "solver.contact_iterations",
     .type = integer,
     .unit = "sweeps",
     .byDefault = "10",
     .min = 0,
     .max = 1000,
     .method = "paper",
     .help = "Sweeps over the contact levels; restitution climbs from -1 + 1/n to 0. Too few and "
             "weight does not travel down: a heavy body hardly loads what is under it. 0 makes "
             "bodies weightless to others and exists to show why the sweeps are needed."},
    {.path = "solver.level_iterations",
     .type = integer,
     .unit = "visits",
     .byDefault = "2",
     .min = 1,
     .max = 1000,
     .method = "paper",
     .help = "Visits of each level within one contact sweep. More helps bodies of one level that "
             "lean on each other."},
    {.path = "solver.pair_impulses",
     .type = integer,
     .unit = "impulses",
     .byDefault = "20",
     .min = 1,
     .max = 10000,
     .method = "paper",
     .help =
         "Impulses a resting pair may receive in one visit. Too few and bodies rock from corner "
         "to corner."},
    {.path = "solver.shock_propagation",
     .type = boolean,
     .byDefault = "true",
     .help = "One last sweep upward in which finished levels become immovable. Without it tall "
             "stacks sink into each other and fall."},
    {.path = "solver.shock_pair_impulses",
     .type = integer,
     .unit = "impulses",
     .byDefault = "10",
     .min = 1,
     .max = 10000,
     .method = "paper",
     .help = "Impulses a pair may receive in one visit of the shock sweep."},
    {.path = "solver.push_out",
     .type = boolean,
     .byDefault = "true",
     .help = "Moves apart, without giving them velocity, bodies that still overlap at the end of a "
             "step. Off, an overlap that once arose stays."},
    {.path = "solver.push_out_level_iterations",
     .type = integer,
     .unit = "visits",
     .byDefault = "4",
     .min = 1,
     .max = 1000,
     .help = "Visits of each level while pushing out: visit l of n removes l/n of the depth. 1 "
             "removes all at once and makes deep overlaps pop."},
    {.path = "solver.push_out_pair_impulses",
     .type = integer,
     .unit = "pushes",
     .byDefault = "5",
     .min = 1,
     .max = 10000,
     .method = "paper",
     .help = "Pushes a pair may receive in one visit."},
    {.path = "solver.orientation",
     .type = word,
     .byDefault = "\"symplectic\"",
     .choices = "symplectic|second_order|euler",
     .help =
         "How orientation follows from angular momentum. With \"symplectic\" the energy of what "
         "tumbles does not drift, and discs, rings and rods turn exactly; \"euler\" is the "
         "paper's and gains energy, \"second_order\" gains less."},
    {.path = "solver.substeps",
     .type = table,
     .byDefault = "{}",
     .help = "How many time steps a frame is divided into. The program chooses a number between "
             "min and max from speeds and thicknesses. What would take method \"scree\" more than "
             "40 / safety is a blur between two frames; it takes more only where it is thin."},
    {.path = "solver.substeps.min",
     .type = integer,
     .unit = "steps/frame",
     .byDefault = "1",
     .min = 1,
     .max = 100000,
     .help = "At least so many steps a frame. With min = max the steps have equal length."},
    {.path = "solver.substeps.max",
     .type = integer,
     .unit = "steps/frame",
     .byDefault = "256",
     .min = 1,
     .max = 100000,
     .help = "At most so many steps a frame. Reaching it is reported: fast thin bodies may then "
             "pass through others."},
    {.path = "solver.substeps.safety",
     .byDefault = "0.5",
     .min = 0,
     .max = 100,
     .isOpen = true,
     .help = "Factor on the longest allowed step. 1 is twice as fast and misses more contacts; "
             "small values are slow and safe."},
    {.path = "solver.maximum_spin",
     .unit = "degrees/step",
     .byDefault = "17.188733853924695",
     .min = 0,
     .max = 360,
     .isOpen = true,
     .help = "How far a body may turn in one step, whatever safety is; what is round does not "
             "count as turning about its own axis, and method \"scree\" lets what is a blur "
             "between two frames (substeps) turn eight times as far. Large values let spinning "
             "corners skip through what they should hit."},
    {.path = "solver.hover",
     .unit = "of the inner thickness",
     .byDefault = "0.0005",
     .min = 0,
     .max = 1,
     .isOpen = true,
     .method = "paper",
     .help = "Largest gap under a resting body, as a fraction of its thickness. It limits the time "
             "step of bodies in contact: small values cost steps, large ones show as floating."},
    {.path = "solver.penetration",
     .type = table,
     .byDefault = "{}",
     .help = "Limits of overlap between bodies."},
    {.path = "solver.penetration.warn",
     .unit = "of the smaller body's longest box edge",
     .byDefault = "0.01",
     .min = 0,
     .max = kInfinity,
     .isOpen = true,
     .help = "Overlap beyond which a frame is reported."},
    {.path = "solver.penetration.fail",
     .unit = "of the smaller body's longest box edge",
     .byDefault = "0.1",
     .min = 0,
     .max = kInfinity,
     .isOpen = true,
     .help = "Overlap beyond which the run ends with exit code 79."},
    {.path = "solver.strict",
     .type = boolean,
     .byDefault = "false",
     .help = "The paper without the repairs documented beside it, whatever the other keys say: "
             "orientation \"euler\", field \"grid\" for all shapes, sliding friction that may add "
             "energy, shock that freezes free clusters, contacts that brake rolling. For "
             "comparison only."},
    {.path = "solver.collision",
     .type = word,
     .byDefault = "\"reevolve\"",
     .choices = "reevolve|lagged",
     .method = "paper",
     .help = "How a colliding pair is worked on. \"reevolve\" looks again after every impulse; "
             "\"lagged\" looks once a visit, which is faster for bodies of many points and coarser "
             "in the outcome. Resting contact always looks again."},
    {.path = "solver.combine",
     .type = table,
     .byDefault = "{}",
     .help = "How a pair's properties follow from its two materials. [[pair]] makes exceptions."},
    {.path = "solver.combine.friction",
     .type = word,
     .byDefault = "\"max\"",
     .choices = "min|max|mean|geometric|multiply",
     .help =
         "With \"max\", the paper's, a slippery body on a rough floor is rough; with \"min\" it "
         "is slippery. \"geometric\" and \"multiply\" are 0 when either is."},
    {.path = "solver.combine.restitution",
     .type = word,
     .byDefault = "\"min\"",
     .choices = "min|max|mean|geometric|multiply",
     .help = "With \"min\", the paper's, a bouncy ball lands dead on sand; with \"max\" it bounces "
             "on anything."},
};

const std::vector<ShotKey> kStartKeys = {
    {.path = "start",
     .type = table,
     .byDefault = "{}",
     .help = "What happens before the first frame."},
    {.path = "start.overlap",
     .type = word,
     .byDefault = "\"error\"",
     .choices = "error|warn|separate",
     .help =
         "What to do with bodies that overlap by more than solver.penetration.warn where the "
         "shot puts them, or go through a wall of each other, however thin: \"error\" names them "
         "and stops, \"warn\" names them and goes on (most "
         "come apart while the shot runs, which shows; a body in the place of its copy stays "
         "there), \"separate\" pushes them apart before the first frame, giving them no velocity; "
         "what crosses is moved the shortest way out. That may take minutes where hundreds of thin "
         "things cross, and says how many are left; what will not come apart stops the shot."},
};

}  // namespace

void appendSetupKeys(std::vector<ShotKey>& keys)
{
    for (const auto* part : {&kFileKeys, &kShotKeys, &kSolverKeys, &kStartKeys}) {
        keys.insert(keys.end(), part->begin(), part->end());
    }
}

}  // namespace scree
