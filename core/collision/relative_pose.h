// Where the samples of one body lie in the frame of the other.
#pragma once

#include "core/math/types.h"

namespace scree {

/// Turns points of the body that is sampled into the frame of the one whose field is asked.
struct FieldFromSamples {
    Mat3 rotation;
    Vec3 translation;  ///< [m]

    Vec3 operator*(const Vec3& p) const { return rotation * p + translation; }
    /// From the field's frame back to that of the samples.
    Vec3 back(const Vec3& p) const { return rotation.transpose() * (p - translation); }
};

inline FieldFromSamples relativePose(const Pose& worldFromField, const Pose& worldFromSamples)
{
    const Mat3 fieldFromWorld = worldFromField.orientation.toRotationMatrix().transpose();
    return {fieldFromWorld * worldFromSamples.orientation.toRotationMatrix(),
            fieldFromWorld * (worldFromSamples.position - worldFromField.position)};
}

}  // namespace scree
