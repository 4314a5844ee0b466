// What the rasteriser keeps in OpenGL's memory: programs, meshes and things to draw into. OpenGL's
// own types stay in the .cpp file; here a name is the number it is. All of it belongs to the
// context and goes with it, so nothing here has a destructor.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/picture/shaded_mesh.h"
#include "render/depth_map.h"
#include "render/look.h"
#include "render/view_fit.h"

namespace scree {

/// Throws Error{internal} for what cannot happen with a complete OpenGL 3.3.
[[noreturn]] void failInOpenGl(const std::string& what);

/// A vertex and a fragment shader. Setting a uniform the compiler found unused does nothing.
class Program {
public:
    Program() = default;

    /// GLSL without the version line. Throws Error{internal} with the compiler's log.
    Program(const std::string& vertex, const std::string& fragment);

    void use() const;
    void set(const char* name, const Mat4& value) const;
    void set(const char* name, const Vec3& value) const;
    void set(const char* name, double x, double y) const;
    void set(const char* name, double value) const;
    void set(const char* name, int value) const;
    void set(const char* name, int x, int y) const;

private:
    int place(const char* name) const;
    void attach(unsigned kind, const std::string& text) const;

    unsigned id_ = 0;
};

/// A square texture that is filled from memory.
struct MapTexture {
    unsigned texture = 0;
    int size = 0;
};

/// Depths; reading them gives the share of neighbouring texels that are at least as deep as asked.
/// Beyond the map the outermost texels go on, which are empty or beside the picture: fitDepthMap().
void uploadDepths(MapTexture& target, const DepthMap& map);
void uploadBounds(MapTexture& target, const DepthBounds& bounds);

/// Moments under a narrow and a wide blur, four numbers a texel. The outermost texels, which go on
/// beyond the map, say that everything is far below.
void uploadMoments(MapTexture& target, const DepthMoments& near, const DepthMoments& wide);

/// Where a picture is drawn: one or two by two points for each pixel, and then the pixels
/// themselves.
struct PictureTarget {
    unsigned points = 0, pixels = 0;            // framebuffers
    unsigned pointColors = 0;                   // texture
    unsigned pointDepths = 0, pixelColors = 0;  // renderbuffers
    int width = 0, height = 0;                  // in pixels
};

void resizePicture(PictureTarget& target, int width, int height, int pointsPerEdge);

/// A mesh in OpenGL's memory and the bodies that share it, drawn by one call.
struct MeshBuffers {
    unsigned vertexArray = 0, instanceBuffer = 0;
    int indexCount = 0;
    int instanceCount = 0;  // of the present picture
    bool isClosed = false;
    Ball ball;  // asset frame
    std::vector<std::size_t> bodies;

    void draw() const;
};

MeshBuffers uploadMesh(const ShadedMesh& mesh);

/// Appends one body as the vertex shader wants it: three rows of worldFromAsset, color, roughness.
/// `linear` is a rotation, or whatever else the points should be multiplied by.
void appendInstance(std::vector<float>& instances, const Mat3& linear, const Vec3& position,
                    const Look& look);

/// Replaces the bodies drawn by buffers.draw().
void uploadInstances(MeshBuffers& buffers, const std::vector<float>& instances);

}  // namespace scree
