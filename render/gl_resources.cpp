// The calls of OpenGL behind gl_resources.h.
#include "render/gl_resources.h"

#define GL_GLEXT_PROTOTYPES 1
#include <GL/gl.h>

#include <GL/glext.h>

#include <array>
#include <span>

#include "core/base/check.h"
#include "core/base/error.h"
#include "render/shaders.h"

namespace scree {
namespace {

constexpr int kFloatsPerInstance = 16;

void requireComplete(const char* what)
{
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        failInOpenGl(std::string("cannot draw into ") + what);
}

/// Bilinear filtering; outside the texture everything reads as the nearest texel. A border of
/// another value would cost a software rasteriser a comparison for every texel it reads.
void setSampling()
{
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void attachBuffer(GLuint buffer, GLenum format, GLenum attachment, int width, int height)
{
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorage(GL_RENDERBUFFER, format, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
}

/// Makes the names of a target that is new.
void makeNames(PictureTarget& target)
{
    if (target.width > 0) return;
    glGenFramebuffers(1, &target.points);
    glGenFramebuffers(1, &target.pixels);
    glGenTextures(1, &target.pointColors);
    glGenRenderbuffers(1, &target.pointDepths);
    glGenRenderbuffers(1, &target.pixelColors);
}

template <class T>
void uploadBuffer(GLenum target, std::span<const T> data, GLenum usage)
{
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(target, buffer);
    glBufferData(target, static_cast<GLsizeiptr>(data.size_bytes()), data.data(), usage);
}

void setAttribute(GLuint index, int floatCount, int stride, int offset, GLuint divisor)
{
    const auto start = reinterpret_cast<const void*>(sizeof(float) * offset);
    glVertexAttribPointer(index, floatCount, GL_FLOAT, GL_FALSE,
                          static_cast<GLsizei>(sizeof(float) * stride), start);
    glEnableVertexAttribArray(index);
    glVertexAttribDivisor(index, divisor);
}

}  // namespace

void failInOpenGl(const std::string& what)
{
    throw Error(ErrorKind::internal, "OpenGL: " + what);
}

// ---------------------------------------------------------------------------------------- programs

Program::Program(const std::string& vertex, const std::string& fragment) : id_(glCreateProgram())
{
    attach(GL_VERTEX_SHADER, vertex);
    attach(GL_FRAGMENT_SHADER, fragment);
    glLinkProgram(id_);
    GLint isLinked = GL_FALSE;
    glGetProgramiv(id_, GL_LINK_STATUS, &isLinked);
    if (isLinked) return;
    std::array<char, 4096> log{};
    glGetProgramInfoLog(id_, log.size(), nullptr, log.data());
    failInOpenGl(std::string("cannot link a program: ") + log.data());
}

void Program::attach(unsigned kind, const std::string& text) const
{
    const std::string whole = shader::kVersion + text;
    const char* source = whole.c_str();
    const GLuint part = glCreateShader(kind);
    glShaderSource(part, 1, &source, nullptr);
    glCompileShader(part);
    GLint isCompiled = GL_FALSE;
    glGetShaderiv(part, GL_COMPILE_STATUS, &isCompiled);
    if (!isCompiled) {
        std::array<char, 4096> log{};
        glGetShaderInfoLog(part, log.size(), nullptr, log.data());
        failInOpenGl(std::string("cannot compile a shader: ") + log.data());
    }
    glAttachShader(id_, part);
    glDeleteShader(part);
}

int Program::place(const char* name) const
{
    return glGetUniformLocation(id_, name);
}

void Program::use() const
{
    glUseProgram(id_);
}

void Program::set(const char* name, const Mat4& value) const
{
    const Eigen::Matrix4f single = value.cast<float>();
    glUniformMatrix4fv(place(name), 1, GL_FALSE, single.data());
}

void Program::set(const char* name, const Vec3& value) const
{
    const Eigen::Vector3f single = value.cast<float>();
    glUniform3fv(place(name), 1, single.data());
}

void Program::set(const char* name, double x, double y) const
{
    glUniform2f(place(name), static_cast<float>(x), static_cast<float>(y));
}

void Program::set(const char* name, double value) const
{
    glUniform1f(place(name), static_cast<float>(value));
}

void Program::set(const char* name, int value) const
{
    glUniform1i(place(name), value);
}

void Program::set(const char* name, int x, int y) const
{
    glUniform2i(place(name), x, y);
}

// ----------------------------------------------------------------------------------------- targets

/// Puts values into a texture, which is made or given another size as needed.
void upload(MapTexture& target, int size, GLint kept, GLenum given,
            const std::vector<float>& values)
{
    if (target.texture == 0) glGenTextures(1, &target.texture);
    glBindTexture(GL_TEXTURE_2D, target.texture);
    if (target.size == size)
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size, size, given, GL_FLOAT, values.data());
    else
        glTexImage2D(GL_TEXTURE_2D, 0, kept, size, size, 0, given, GL_FLOAT, values.data());
    target.size = size;
}

void uploadDepths(MapTexture& target, const DepthMap& map)
{
    upload(target, map.size, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, map.depths);
    setSampling();
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
}

void uploadMoments(MapTexture& target, const DepthMoments& near, const DepthMoments& wide)
{
    SCREE_CHECK(near.size == wide.size, "moments of two maps");
    constexpr std::array<float, 4> kFarBelow = {100.0f, 10000.0f, 100.0f, 10000.0f};
    const int last = near.size - 1;
    std::vector<float> values;
    values.reserve(2 * near.values.size());
    for (int y = 0; y <= last; ++y) {
        for (int x = 0; x <= last; ++x) {
            const std::size_t texel = 2 * (static_cast<std::size_t>(y) * near.size + x);
            const bool isBorder = x == 0 || y == 0 || x == last || y == last;
            const std::array<float, 4> four = {near.values[texel], near.values[texel + 1],
                                               wide.values[texel], wide.values[texel + 1]};
            const std::array<float, 4>& kept = isBorder ? kFarBelow : four;
            values.insert(values.end(), kept.begin(), kept.end());
        }
    }
    upload(target, near.size, GL_RGBA32F, GL_RGBA, values);
    setSampling();
}

void uploadBounds(MapTexture& target, const DepthBounds& bounds)
{
    upload(target, bounds.size, GL_RG32F, GL_RG, bounds.values);
    setSampling();
}

void resizePicture(PictureTarget& target, int width, int height, int pointsPerEdge)
{
    if (target.width == width && target.height == height) return;
    makeNames(target);
    target.width = width;
    target.height = height;
    const int pointWidth = pointsPerEdge * width, pointHeight = pointsPerEdge * height;
    glBindFramebuffer(GL_FRAMEBUFFER, target.points);
    glBindTexture(GL_TEXTURE_2D, target.pointColors);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, pointWidth, pointHeight, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 nullptr);
    setSampling();
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.pointColors,
                           0);
    attachBuffer(target.pointDepths, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT, pointWidth,
                 pointHeight);
    requireComplete("a picture");
    glBindFramebuffer(GL_FRAMEBUFFER, target.pixels);
    attachBuffer(target.pixelColors, GL_RGBA8, GL_COLOR_ATTACHMENT0, width, height);
    requireComplete("a picture");
}

// ------------------------------------------------------------------------------------------ meshes

void MeshBuffers::draw() const
{
    if (instanceCount == 0) return;
    glBindVertexArray(vertexArray);
    glDrawElementsInstanced(GL_TRIANGLES, indexCount, GL_UNSIGNED_INT, nullptr, instanceCount);
}

MeshBuffers uploadMesh(const ShadedMesh& mesh)
{
    MeshBuffers buffers;
    glGenVertexArrays(1, &buffers.vertexArray);
    glBindVertexArray(buffers.vertexArray);
    uploadBuffer(GL_ARRAY_BUFFER, std::span(mesh.points), GL_STATIC_DRAW);
    setAttribute(0, 3, 3, 0, 0);
    uploadBuffer(GL_ARRAY_BUFFER, std::span(mesh.normals), GL_STATIC_DRAW);
    setAttribute(1, 3, 3, 0, 0);
    uploadBuffer(GL_ELEMENT_ARRAY_BUFFER, std::span(mesh.indices), GL_STATIC_DRAW);
    glGenBuffers(1, &buffers.instanceBuffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffers.instanceBuffer);
    for (GLuint k = 0; k < 4; ++k)
        setAttribute(2 + k, 4, kFloatsPerInstance, 4 * static_cast<int>(k), 1);
    buffers.indexCount = static_cast<GLsizei>(mesh.indices.size());
    buffers.isClosed = mesh.isClosed;
    buffers.ball = {mesh.centre, mesh.radius};
    return buffers;
}

void appendInstance(std::vector<float>& instances, const Mat3& linear, const Vec3& position,
                    const Look& look)
{
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            instances.push_back(static_cast<float>(linear(row, column)));
        instances.push_back(static_cast<float>(position[row]));
    }
    for (int channel = 0; channel < 3; ++channel)
        instances.push_back(static_cast<float>(look.color[channel]));
    instances.push_back(static_cast<float>(look.roughness));
}

void uploadInstances(MeshBuffers& buffers, const std::vector<float>& instances)
{
    buffers.instanceCount = static_cast<GLsizei>(instances.size() / kFloatsPerInstance);
    glBindBuffer(GL_ARRAY_BUFFER, buffers.instanceBuffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances.size() * sizeof(float)),
                 instances.data(), GL_STREAM_DRAW);
}

}  // namespace scree
