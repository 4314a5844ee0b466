// Four numbers side by side: the same arithmetic on four independent problems at once. Lanes never
// mix, and no operation is contracted, so that a lane computes the bits it would compute alone.
#pragma once

#include <immintrin.h>

#include "core/math/types.h"

namespace scree {

inline constexpr int kLanes = 4;

// Compiled for x86-64-v3 like all of Scree: one 256-bit register.
using Lanes = double __attribute__((vector_size(8 * kLanes)));

inline constexpr Lanes kNoLanes = {0.0, 0.0, 0.0, 0.0};

/// What comparing lanes says: all bits of a lane, or none.
using LaneMask = decltype(kNoLanes > kNoLanes);

/// Bit i tells of lane i.
inline unsigned bitsOf(LaneMask mask)
{
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
}

inline Lanes lanesOf(double value)
{
    return Lanes{value, value, value, value};
}
inline Lanes maxOf(Lanes a, Lanes b)
{
    return a > b ? a : b;
}
inline Lanes absOf(Lanes a)
{
    return maxOf(a, -a);
}
inline Lanes sqrtOf(Lanes a)
{
    return _mm256_sqrt_pd(a);
}
inline double sumOf(Lanes a)
{
    return (a[0] + a[1]) + (a[2] + a[3]);
}
inline double largestOf(Lanes a)
{
    const double low = a[0] > a[1] ? a[0] : a[1], high = a[2] > a[3] ? a[2] : a[3];
    return low > high ? low : high;
}

/// Four vectors.
struct Lanes3 {
    Lanes x = kNoLanes, y = kNoLanes, z = kNoLanes;

    void set(int lane, const Vec3& v)
    {
        x[lane] = v.x();
        y[lane] = v.y();
        z[lane] = v.z();
    }
    static Lanes3 all(const Vec3& v) { return {lanesOf(v.x()), lanesOf(v.y()), lanesOf(v.z())}; }
    static Lanes3 of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
    {
        return {Lanes{a.x(), b.x(), c.x(), d.x()}, Lanes{a.y(), b.y(), c.y(), d.y()},
                Lanes{a.z(), b.z(), c.z(), d.z()}};
    }
    Vec3 get(int lane) const { return {x[lane], y[lane], z[lane]}; }

    Lanes3& operator+=(const Lanes3& o)
    {
        x += o.x;
        y += o.y;
        z += o.z;
        return *this;
    }
    Lanes3& operator-=(const Lanes3& o)
    {
        x -= o.x;
        y -= o.y;
        z -= o.z;
        return *this;
    }
};

inline Lanes3 operator+(const Lanes3& a, const Lanes3& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Lanes3 operator-(const Lanes3& a, const Lanes3& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Lanes3 operator*(Lanes s, const Lanes3& a)
{
    return {s * a.x, s * a.y, s * a.z};
}
inline Lanes dot(const Lanes3& a, const Lanes3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Lanes3 cross(const Lanes3& a, const Lanes3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Four symmetric matrices.
struct SymmetricLanes {
    Lanes xx = kNoLanes, yy = kNoLanes, zz = kNoLanes, xy = kNoLanes, xz = kNoLanes, yz = kNoLanes;

    void set(int lane, const Mat3& m)
    {
        xx[lane] = m(0, 0);
        yy[lane] = m(1, 1);
        zz[lane] = m(2, 2);
        xy[lane] = m(0, 1);
        xz[lane] = m(0, 2);
        yz[lane] = m(1, 2);
    }
    Lanes3 operator*(const Lanes3& v) const
    {
        return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z,
                xz * v.x + yz * v.y + zz * v.z};
    }
};

}  // namespace scree
