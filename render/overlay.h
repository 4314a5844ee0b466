// Marks of what the solver did, drawn over a picture: they show through the bodies, because most
// contacts of a heap are inside it.
#pragma once

#include <vector>

#include "render/camera.h"
#include "render/image.h"

namespace scree {

inline const Color kContactColor(0.95f, 0.80f, 0.10f), kNormalColor(0.05f, 0.65f, 0.85f),
    kForceColor(0.90f, 0.05f, 0.04f);

/// One contact: a dot, and a line each for the normal and the force. Lengths are in the unit of the
/// scene.
struct ContactMark {
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::Zero();  ///< as long as it is to be drawn
    Vec3 force = Vec3::Zero();   ///< likewise
};

/// A straight line from `from` to `to` [pixels, y downwards] with soft edges; what lies outside the
/// picture is left out.
void drawLine(Image& image, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width,
              const Color& color);

/// Forces lie over normals, dots over both. Marks behind the eye are left out.
void drawContacts(Image& image, const Camera& camera, const std::vector<ContactMark>& marks);

}  // namespace scree
