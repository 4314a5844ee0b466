// E16: how high a ball bounces; E28 asks more of method scree on the same shot. [A28]
#include <cmath>

#include "tools/verify/experiments.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

struct Bounces {
    std::vector<double> apexes;  // of the ball's lowest point [m]
    Curve height;
};

/// Looks at the ball after every step and notes how high it came.
///
/// The top of its way lies between two steps, up to g dt²/8 above both: by the highest of them a
/// ball that keeps its height to 1e-12 m loses and gains a micrometre at 960 Hz, in turn. Free
/// flight lies on a parabola with either method, so three steps tell its top.
class ApexWatch {
public:
    explicit ApexWatch(const ShotRun& run) : ball_(run.body("ball")) {}

    void look(const World& world, double time)
    {
        const double speed = world.motion[ball_].velocity.y();
        const double height = world.motion[ball_].position.y() - 0.5;
        result.height.x.push_back(time);
        result.height.y.push_back(height);
        if (speed_ > 0.0 && speed <= 0.0) result.apexes.push_back(apex());
        speed_ = speed;
    }

    Bounces result;

private:
    /// Of the parabola through the last three heights.
    double apex() const
    {
        const std::vector<double>& h = result.height.y;
        const double before = h[h.size() - 3], middle = h[h.size() - 2], after = h.back();
        const double slope = 0.5 * (after - before), bend = after - 2.0 * middle + before;
        return middle - 0.5 * slope * slope / bend;
    }

    BodyId ball_;
    double speed_ = 0.0;
};

Bounces bounce(const Context& context, double restitution, double rate, double seconds)
{
    const std::string e = setNumber("material.ball.restitution", restitution);
    ShotRun run(context, "E16_bounce", {e});
    ApexWatch watch(run);
    run.advance(seconds, rate, [&](const StepReport&, double t) { watch.look(run.world, t); });
    watch.result.height.name = "restitution " + shortNumber(restitution);
    return watch.result;
}

}  // namespace

void runBounce(const Context& context, Findings& findings)
{
    const double impact = std::sqrt(2.0 * 9.8 * 5.0);
    Plot plot{"Height of a ball over a floor, 240 Hz", "time [s]", "height [m]", {}};
    for (double rate : {240.0, 960.0}) {
        const Bounces run = bounce(context, 1.0, rate, 7.0);
        double apex = 5.0, lost = 0.0, gained = -1e300;
        for (double now : run.apexes) {
            lost = larger(lost, apex - now);
            gained = larger(gained, now - apex);
            apex = now;
        }
        const std::string at = shortNumber(rate) + " Hz";
        findings.equal(must, "restitution 1, " + at + ": bounces within 7 s",
                       static_cast<double>(run.apexes.size()), 3);
        findings.atMost(must, "restitution 1, " + at + ": height lost in a bounce", lost,
                        1.1 * impact / rate, "m", "a step of its fall, known as A28");
        findings.atMost(must, "restitution 1, " + at + ": height gained in a bounce", gained, 0.0,
                        "m");
        if (rate == 240.0) plot.curves.push_back(run.height);
    }
    const Bounces half = bounce(context, 0.5, 240.0, 2.0);
    findings.near(must, "restitution 0.5, 240 Hz: first rebound",
                  half.apexes.empty() ? std::nan("") : half.apexes.front(), 1.25,
                  2.0 * impact / 240.0, "m");
    plot.curves.push_back(half.height);
    findings.plots.push_back(plot);
}

/// A must for method scree; the paper's method is measured and told.
void runBounceHeight(const Context& context, Findings& findings)
{
    const Weight weight = context.method == "scree" ? must : goal;
    const bool isFull = context.isFull();
    const std::vector<double> drops =
        isFull ? std::vector{0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0} : std::vector{0.01, 0.1, 1.0};
    const std::vector<double> restitutions =
        isFull ? std::vector{0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0}
               : std::vector{0.2, 0.5, 0.8, 1.0};
    for (double drop : drops) {
        double worst = 0.0, gained = -1e300;
        for (double e : restitutions) {
            const std::string height = setVector("body.ball.position", {0.0, 0.5 + drop, 0.0});
            ShotRun run(context, "E16_bounce",
                        {setNumber("material.ball.restitution", e), height, "solver.substeps.min=1",
                         "solver.substeps.max=256"});
            double highest = 0.0;
            bool hasBounced = false;
            // The apex between two steps, from height and speed: m g h + ½ m v².
            const double time = std::sqrt(2.0 * drop / 9.8) * (1.0 + 1.2 * e);
            const BodyId ball = run.body("ball");
            const auto look = [&](const World& world, double) {
                const double v = world.motion[ball].velocity.y();
                hasBounced = hasBounced || v > 0.0;
                if (!hasBounced) return;
                const double above = world.motion[ball].position.y() - 0.5;
                highest = larger(highest, above + 0.5 * v * v / 9.8);
            };
            for (int frame = 0; frame < std::ceil(24.0 * time) + 1.0; ++frame) {
                run.stepper.advanceFrame(run.world, 1.0 / 24.0, {}, look);
            }
            worst = larger(worst, std::abs(highest - e * e * drop) / (e * e * drop));
            gained = larger(gained, highest - drop);
        }
        const std::string name = "drop of " + shortNumber(drop) + " m, default steps: ";
        findings.atMost(weight, name + "rebound off e^2 h", worst, 0.01, "relative");
        findings.atMost(weight, name + "rises above the start by", gained, 1e-9, "m");
    }
}

}  // namespace scree::verify
