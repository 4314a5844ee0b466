// Numbers side by side: the same arithmetic on independent problems at once, four in double and
// eight in single precision. Lanes never mix, and what is multiplied and added at once is said so,
// not left to the compiler: a lane computes the same bits on every machine.
#pragma once

#include <immintrin.h>

#include <type_traits>
#include <utility>

#include "core/math/types.h"

namespace scree {

inline constexpr int kLanes = 4;
inline constexpr int kFloatLanes = 8;

// Compiled for x86-64-v3 like all of Scree: one 256-bit register.
using Lanes = double __attribute__((vector_size(8 * kLanes)));
/// For filters, which may err to the safe side.
using FloatLanes = float __attribute__((vector_size(4 * kFloatLanes)));
using IntLanes = int __attribute__((vector_size(4 * kFloatLanes)));

inline constexpr Lanes kNoLanes = {0.0, 0.0, 0.0, 0.0};

/// What comparing lanes says: all bits of a lane, or none. Of eight it is IntLanes.
using LaneMask = decltype(kNoLanes > kNoLanes);

/// Bit i tells of lane i.
inline unsigned bitsOf(LaneMask mask)
{
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
}
inline unsigned bitsOf(IntLanes mask)
{
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
}

inline Lanes lanesOf(double value)
{
    return Lanes{value, value, value, value};
}
inline FloatLanes floatLanesOf(double value)
{
    const auto v = static_cast<float>(value);
    return FloatLanes{v, v, v, v, v, v, v, v};
}
template <class L>
L maxOf(L a, L b)
{
    return a > b ? a : b;
}
template <class L>
L minOf(L a, L b)
{
    return a < b ? a : b;
}
template <class L>
L absOf(L a)
{
    return maxOf(a, -a);
}
inline Lanes sqrtOf(Lanes a)
{
    return _mm256_sqrt_pd(a);
}
inline FloatLanes sqrtOf(FloatLanes a)
{
    return _mm256_sqrt_ps(a);
}
/// a b + c, rounded once.
inline Lanes fma(Lanes a, Lanes b, Lanes c)
{
    return _mm256_fmadd_pd(a, b, c);
}
inline FloatLanes fma(FloatLanes a, FloatLanes b, FloatLanes c)
{
    return _mm256_fmadd_ps(a, b, c);
}
/// c - a b.
inline Lanes fnma(Lanes a, Lanes b, Lanes c)
{
    return _mm256_fnmadd_pd(a, b, c);
}
inline FloatLanes fnma(FloatLanes a, FloatLanes b, FloatLanes c)
{
    return _mm256_fnmadd_ps(a, b, c);
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
inline float sumOf(FloatLanes a)
{
    float sum = a[0];
    for (int lane = 1; lane < kFloatLanes; ++lane) sum += a[lane];
    return sum;
}
inline float largestOf(FloatLanes a)
{
    float largest = a[0];
    for (int lane = 1; lane < kFloatLanes; ++lane) largest = a[lane] > largest ? a[lane] : largest;
    return largest;
}
inline float leastOf(FloatLanes a)
{
    float least = a[0];
    for (int lane = 1; lane < kFloatLanes; ++lane) least = a[lane] < least ? a[lane] : least;
    return least;
}
/// values[index], lane by lane.
inline FloatLanes gathered(const float* values, IntLanes index)
{
    return _mm256_i32gather_ps(values, reinterpret_cast<__m256i>(index), 4);
}

/// Vectors side by side.
template <class L>
struct VectorLanes {
    using Number = std::remove_reference_t<decltype(std::declval<L&>()[0])>;

    L x = {}, y = {}, z = {};

    void set(int lane, const Vec3& v)
    {
        x[lane] = static_cast<Number>(v.x());
        y[lane] = static_cast<Number>(v.y());
        z[lane] = static_cast<Number>(v.z());
    }
    static VectorLanes all(const Vec3& v)
    {
        const L none = {};
        return {none + static_cast<Number>(v.x()), none + static_cast<Number>(v.y()),
                none + static_cast<Number>(v.z())};
    }
    Vec3 get(int lane) const { return {x[lane], y[lane], z[lane]}; }

    VectorLanes& operator+=(const VectorLanes& o)
    {
        x += o.x;
        y += o.y;
        z += o.z;
        return *this;
    }
    VectorLanes& operator-=(const VectorLanes& o)
    {
        x -= o.x;
        y -= o.y;
        z -= o.z;
        return *this;
    }
};

using Lanes3 = VectorLanes<Lanes>;
using FloatLanes3 = VectorLanes<FloatLanes>;

inline Lanes3 lanesOf(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    return {Lanes{a.x(), b.x(), c.x(), d.x()}, Lanes{a.y(), b.y(), c.y(), d.y()},
            Lanes{a.z(), b.z(), c.z(), d.z()}};
}

template <class L>
VectorLanes<L> operator+(const VectorLanes<L>& a, const VectorLanes<L>& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class L>
VectorLanes<L> operator-(const VectorLanes<L>& a, const VectorLanes<L>& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class L>
VectorLanes<L> operator*(L s, const VectorLanes<L>& a)
{
    return {s * a.x, s * a.y, s * a.z};
}
template <class L>
L dot(const VectorLanes<L>& a, const VectorLanes<L>& b)
{
    return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x));
}
template <class L>
VectorLanes<L> cross(const VectorLanes<L>& a, const VectorLanes<L>& b)
{
    return {fnma(a.z, b.y, a.y * b.z), fnma(a.x, b.z, a.z * b.x), fnma(a.y, b.x, a.x * b.y)};
}
/// s a + b.
template <class L>
VectorLanes<L> fma(L s, const VectorLanes<L>& a, const VectorLanes<L>& b)
{
    return {fma(s, a.x, b.x), fma(s, a.y, b.y), fma(s, a.z, b.z)};
}
/// b - s a.
template <class L>
VectorLanes<L> fnma(L s, const VectorLanes<L>& a, const VectorLanes<L>& b)
{
    return {fnma(s, a.x, b.x), fnma(s, a.y, b.y), fnma(s, a.z, b.z)};
}

/// One rotation for all lanes.
class RotationLanes {
public:
    explicit RotationLanes(const Mat3& rotation)
        : rows_{FloatLanes3::all(rotation.row(0)), FloatLanes3::all(rotation.row(1)),
                FloatLanes3::all(rotation.row(2))}
    {
    }
    FloatLanes3 operator*(const FloatLanes3& v) const
    {
        return {dot(rows_[0], v), dot(rows_[1], v), dot(rows_[2], v)};
    }

private:
    FloatLanes3 rows_[3];
};

/// Four symmetric matrices.
struct SymmetricLanes {
    Lanes xx = kNoLanes, yy = kNoLanes, zz = kNoLanes, xy = kNoLanes, xz = kNoLanes, yz = kNoLanes;

    static SymmetricLanes all(const Mat3& m)
    {
        return {lanesOf(m(0, 0)), lanesOf(m(1, 1)), lanesOf(m(2, 2)),
                lanesOf(m(0, 1)), lanesOf(m(0, 2)), lanesOf(m(1, 2))};
    }
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
        return {fma(xz, v.z, fma(xy, v.y, xx * v.x)), fma(yz, v.z, fma(yy, v.y, xy * v.x)),
                fma(zz, v.z, fma(yz, v.y, xz * v.x))};
    }
};

}  // namespace scree
