// Mesh files → TriMesh, as the artist made them: nothing is repaired, rescaled or recentred.
//
// Files are foreign and their parsers are known to break on bad ones. They run in a process of
// their own (confined_process.h) that may read the file's folder and nothing else; what it hands
// back is checked like a file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/tri_mesh.h"
#include "io/import_limits.h"

namespace scree {

/// Where a node is at some time.
struct ImportedKey {
    double seconds = 0.0;  ///< of the file
    Pose fileFromNode;
    bool isBetween = false;  ///< the file has none there: where a straight way would stray
};

/// A node of a file that shows a mesh.
struct ImportedNode {
    std::string name;               ///< as in the file; neither unique nor an identifier
    Pose fileFromNode;              ///< lengths of the file; of a moving node the first
    TriMesh mesh;                   ///< in the node's axes, its scale baked
    std::vector<ImportedKey> keys;  ///< in order of time; empty for a node that never moves
    std::string obstacle;           ///< why its motion cannot be played, if so; it has no keys then
    std::string lostJoin;           ///< how its samples are joined in the file, if not straight
    std::string lostClips;          ///< which of several clips of the file it plays, if so
    std::string unusable;           ///< why it is no rigid body, if so; it has no mesh then
    bool isBent = false;            ///< bones or morph targets of the file bend its mesh; lost
};

/// The angle of view of a camera at one moment.
struct ImportedZoom {
    double seconds = 0.0;  ///< of the file
    double fovDegrees = 35.0;
};

/// A camera of a file: x to the right, y upwards, it looks along -z.
struct ImportedCamera {
    std::string name;                ///< of its node
    Pose fileFromCamera;             ///< of a moving one the first
    std::vector<ImportedKey> keys;   ///< in order of time; empty for one that never moves
    double fovDegrees = 35.0;        ///< vertical; of one that zooms the first; 0: orthographic
    std::vector<ImportedZoom> zoom;  ///< in order of time; empty for one that never zooms
    /// Width over height of a film that programs fit to the picture, whatever its shape, and whose
    /// vertical angle is told; 0: the angle is the picture's.
    double filmAspect = 0.0;
    bool isZoomLost = false;  ///< the file has a zoom that cannot be read
    std::string lostJoin;     ///< as of a node
    std::string lostClips;    ///< likewise
    std::string lostLens;     ///< what else its lens does that is not shown here, if so
    std::string unusable;     ///< why nobody can look through it, if so
};

struct ImportedFile {
    std::vector<ImportedNode> nodes;      ///< in the order of the file's tree
    std::vector<ImportedCamera> cameras;  ///< likewise; at least one of both
    bool isYUp = false;                   ///< the format says so
    std::string upAxis;                   ///< "+z", of a file that says so itself; it is not turned
    /// The format or its reader gives faces points of their own, of which equal ones have been
    /// joined: nobody made them two. Otherwise points are as the file has them.
    bool hadLoosePoints = false;
    bool countsFramesFromZero = false;    ///< its time 0 is frame 0, not where its motion begins
    std::optional<double> metresPerUnit;  ///< length of one unit of the file [m], if it says so
};

/// Polygons are cut into triangles. Coordinates pass through single precision. Of texture
/// coordinates the first set is kept; where only a part of a mesh has some, the rest is at (0, 0);
/// those of the faces of a PLY file, of which points know nothing, are left out. Whether a mesh is
/// a solid is not asked here. Throws Error{missingInput} when there is no such file, and
/// Error{badInput} for an unsupported file ending, a file that cannot be read within the limits,
/// one that refers to files outside its folder, one without faces and one with coordinates that are
/// not finite.
ImportedFile importFile(const std::string& path, const ImportLimits& limits = {});

/// Files that a mesh file keeps points and motions in, beside itself: the buffers of glTF.
/// Materials decide nothing here, and theirs are none of them.
std::vector<std::string> partsOfAsset(const std::string& path);

/// Why a node of a file that is unusable cannot be taken, as a sentence.
std::string refusalOf(const ImportedNode& node, const std::string& path);

/// All nodes of a file as one mesh, where they stand; triangles without area are still there. None
/// of them may be unusable.
TriMesh joinedMesh(const ImportedFile& file);

/// joinedMesh of a file. Throws Error{badInput} when a node is unusable.
TriMesh joinedMesh(const ImportedFile& file, const std::string& path);

}  // namespace scree
