#include "tests/support/statics.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace scree::test {
namespace {

/// The best x ≥ 0 for A x = b, by active sets: C. L. Lawson and R. J. Hanson, Solving Least Squares
/// Problems, 1974, chapter 23. Answers what it leaves, |A x − b|.
double leftByNonNegative(const Eigen::MatrixXd& a, const Eigen::VectorXd& b)
{
    constexpr double kZero = 1e-11;
    std::vector<Eigen::Index> chosen;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(a.cols());
    for (Eigen::Index rounds = 0; rounds < 10 * a.cols(); ++rounds) {
        const Eigen::VectorXd left = b - a * x;
        Eigen::VectorXd slope = a.transpose() * left;
        for (const Eigen::Index i : chosen) slope[i] = 0.0;
        Eigen::Index steepest = 0;
        if (slope.maxCoeff(&steepest) < kZero) break;
        chosen.push_back(steepest);
        while (true) {
            const Eigen::VectorXd best = a(Eigen::all, chosen).householderQr().solve(b);
            if (best.minCoeff() > 0.0) {
                x.setZero();
                x(chosen) = best;
                break;
            }
            double way = 1.0;
            for (std::size_t i = 0; i < chosen.size(); ++i) {
                const double now = x[chosen[i]], then = best[static_cast<Eigen::Index>(i)];
                if (then <= 0.0) way = std::min(way, now / (now - then));
            }
            std::vector<Eigen::Index> kept;
            for (std::size_t i = 0; i < chosen.size(); ++i) {
                double& now = x[chosen[i]];
                now += way * (best[static_cast<Eigen::Index>(i)] - now);
                if (now > kZero)
                    kept.push_back(chosen[i]);
                else
                    now = 0.0;
            }
            chosen = kept;
            if (chosen.empty()) break;
        }
    }
    return (b - a * x).norm();
}

}  // namespace

bool canStand(const World& world, const Vec3& gravity, std::span<const Joint> joints, double spare)
{
    const auto bodies = static_cast<Eigen::Index>(world.bodyCount());
    std::vector<Eigen::VectorXd> wrenches;
    const auto add = [&](const Joint& joint, const Vec3& at, const Vec3& force) {
        Eigen::VectorXd wrench = Eigen::VectorXd::Zero(6 * bodies);
        const auto act = [&](BodyId body, const Vec3& f) {
            if (!world.mass[body].isMovable()) return;
            wrench.segment<3>(6 * body) += f;
            wrench.segment<3>(6 * body + 3) += (at - world.motion[body].position).cross(f);
        };
        act(joint.on, force);
        act(joint.against, -force);
        wrenches.push_back(wrench.normalized());
    };
    for (const Joint& joint : joints) {
        Vec3 middle = Vec3::Zero();
        for (const Vec3& corner : joint.corners)
            middle += corner / static_cast<double>(joint.corners.size());
        for (const Vec3& corner : joint.corners) {
            const Vec3 at = corner - spare * (corner - middle);
            for (const Vec3& slide : joint.slides) {
                const Vec3 friction = (1.0 - spare) * joint.friction * slide;
                add(joint, at, joint.normal + friction);
                add(joint, at, joint.normal - friction);
            }
        }
    }
    Eigen::VectorXd weight = Eigen::VectorXd::Zero(6 * bodies);
    for (Eigen::Index body = 0; body < bodies; ++body) {
        const double inverse = world.mass[static_cast<std::size_t>(body)].inverseMass;
        if (inverse > 0.0) weight.segment<3>(6 * body) = -gravity / inverse;
    }
    // What no force and no weight acts along needs no balance.
    std::vector<Eigen::Index> rows;
    for (Eigen::Index row = 0; row < weight.size(); ++row) {
        const bool acts = std::ranges::any_of(
            wrenches, [&](const Eigen::VectorXd& w) { return std::abs(w[row]) > 1e-12; });
        if (acts || weight[row] != 0.0) rows.push_back(row);
    }
    Eigen::MatrixXd forces(rows.size(), wrenches.size());
    for (std::size_t i = 0; i < wrenches.size(); ++i)
        forces.col(static_cast<Eigen::Index>(i)) = wrenches[i](rows);
    return leftByNonNegative(forces, weight(rows).normalized()) < 1e-7;
}

}  // namespace scree::test
