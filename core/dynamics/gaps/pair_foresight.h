// Two bodies on their ways, as they will be when they hit each other.  [A28]
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/dynamics/gaps/gap_held.h"
#include "core/dynamics/gaps/gap_scratch.h"

namespace scree {

/// Places of bodies that turn by more than this until they are hit are hit elsewhere [rad].
inline constexpr double kTurnsOn = 1e-3;

/// The moment of a blow that nobody knows better than its rows.
inline constexpr double kNotKnown = -1.0;

/// A body on its way, if what carried it in the last step still does; t: since the step began.
struct Course {
    Pose start;
    Vec3 velocity, spin, acceleration, turning;

    Course(const World& world, const GapScratch& scratch, const std::vector<Held>& held, BodyId id);

    Vec3 velocityAt(const Vec3& r, double t) const
    {
        return velocity + t * acceleration + (spin + t * turning).cross(r);
    }
    Vec3 placeAt(double t) const
    {
        return start.position + t * velocity + 0.5 * t * t * acceleration;
    }
    Pose poseAt(double t) const;
};

/// What already bears is there to be borne by.
inline bool bears(const GapRow& row)
{
    return row.impulse.x() > 0.0;
}

/// A pair of which something comes closer as fast as that. `room`: for the contacts it will have.
class PairForesight {
public:
    PairForesight(const World& world, const std::vector<Held>& held, GapScratch& scratch,
                  const GapPair& pair, double dt, double fastest, std::vector<GapContact>& room);

    /// What comes closer more slowly is another matter [m/s].
    double fastEnough() const { return fastEnough_; }

    /// Whether what is about to be hit in this step is not.
    bool passes(const std::vector<GapContact>& contacts);

    /// Takes rows from the moment at which the first of them is hit, where that makes a difference.
    /// Answers this moment, or kNotKnown. Their gaps are those of then.
    double aim(const std::vector<GapContact>& contacts, std::span<GapRow> rows);

private:
    struct Blow {
        double time = std::numeric_limits<double>::infinity();
        double speed = 0.0;   // at which the surfaces meet [m/s]
        double seenAt = 0.0;  // when the bodies were where the contact is
        const GapContact* contact = nullptr;
    };

    bool slidesUntil(const Blow& blow) const;
    bool turnsUntil(const Blow& blow) const;
    double lookForBlow(Blow blow);
    double goAlongToBlow(const std::vector<GapContact>& contacts);
    void goAlong(const std::vector<GapContact>& contacts, double t);
    const GapContact* sameAs(const GapContact& contact) const;
    void takeFrom(const GapContact& contact, double t, GapRow& row) const;
    Vec3 velocityOf(const GapContact& contact, double t) const;
    Blow nextBlow(const std::vector<GapContact>& contacts, double t, double speed) const;
    bool goesIn(const Blow& blow, double t) const;
    double fastestOfAll() const;
    void lookAt(double t, double reach);

    const World& world_;
    const GapScratch& scratch_;
    BodyPair bodies_;
    NearFeatures& near_;
    Course a_, b_;
    double dt_, fastEnough_, after_;
    std::vector<GapContact>& found_;
};

}  // namespace scree
