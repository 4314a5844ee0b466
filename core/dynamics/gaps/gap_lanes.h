// The rows of an island four pairs abreast: the fast twin of visitRow. Pairs that share no movable
// body do not see each other's impulses, so visiting them at once is visiting them in order.
//
// A large island is cut in two: the pairs of either half are visited at once by two threads, those
// across the cut after them on the way up and before them on the way down. Whether it is cut does
// not depend on the number of threads, so neither do the bits.
//
// All rows are laid out. Of a thousand rings that fall on each other three in ten end without an
// impulse, but of these only half can be told beforehand, which is not worth a second look.
//
// Eight pairs abreast, with AVX-512, leave more lanes idle: of a run of a thousand rings they saved
// a fiftieth, which is not worth a second path.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/gaps/gap_pairs.h"
#include "core/math/lanes.h"

namespace scree {

/// What a sweep up and down has met.
struct GapSweep {
    double residual = 0.0;  ///< largest change of a velocity at a row [m/s]
    double fastest = 0.0;   ///< of two surfaces against each other, on the way up [m/s]
    double energy = 0.0;    ///< of the change from what the sweep began with [J]
};

/// What impulses have done to the energy in a step, as its sweeps have left them [J]; couples are
/// left out.
struct GapWork {
    double taken = 0.0;  ///< by those that are right, from the motion before the step
    double borne = 0.0;  ///< the same and what pulls had given in the step: where all lies still,
                         ///< what it would have begun to fall with
    double wrong = 0.0;  ///< given by those that push what parts, or rub what follows them
};

class GapLanes {
public:
    /// Lays the rows of an island and their bodies out.
    void build(const GapScratch& scratch, const GapIsland& island);

    /// The bodies take the impulses that the rows begin with.
    void begin();

    /// One sweep up and one down.
    GapSweep sweep();

    /// Goes on along the conjugate direction: what a sweep has changed is a gradient [SNE10]. A
    /// share of the last way above 1 begins anew. Bodies and impulses go when the next sweep comes
    /// by, which must follow.
    void goOn(double share);

    GapWork work(const GapScratch& scratch) const;

    /// Hands impulses and velocities back to rows and bodies.
    void store(GapScratch& scratch);

private:
    /// As many rows of different pairs go into one batch as those that come first: lanes that run
    /// out of rows are idle, and pairs of a heap have from one row to dozens.
    static constexpr std::size_t kRowsTogether = 4;

    struct Row {
        Lanes3 rA, normal, tangent;
        Lanes target = kNoLanes, friction = kNoLanes;
        Lanes normalMass = kNoLanes, inverseNormalMass = kNoLanes;
        Lanes turnsIntoTangent = kNoLanes;  // velocity by a unit normal impulse
        Lanes turnsIntoSecond = kNoLanes;
        Lanes massTt = kNoLanes, massTs = kNoLanes, massSs = kNoLanes;
        Lanes slideMass = kNoLanes, inverseSlideMass = kNoLanes;
        Lanes3 impulse, before, way;  // along normal, tangent, second
    };
    /// What of a row resists rolling and spinning.
    struct Roll {
        Lanes rollingArm = kNoLanes, spinningArm = kNoLanes, lever = kNoLanes;
        Lanes rollMass = kNoLanes, slipMass = kNoLanes;  // of what rolls, and of what slips besides
        Lanes spinMass = kNoLanes;                       // about the normal
        Lanes3 couple, before, way;
    };
    /// What the rows change of a body, one cache line.
    struct alignas(64) LaneBody {
        Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();
    };
    /// A body before the last sweep, and the way it went.
    struct BodyWay {
        LaneBody before, way;
    };
    struct Side {
        std::int32_t body[kLanes];  // index into bodies_
        bool isMovable[kLanes];
        Lanes inverseMass = kNoLanes;
        SymmetricLanes inverseInertia;
    };
    /// Up to kRowsTogether rows each of up to kLanes pairs that share no movable body.
    struct Batch {
        Side a, b;
        Lanes3 bFromA;              // centres: what turns rA into rB
        Lanes3 turning;             // of each row
        Lanes squeeze = kNoLanes;   // of each row
        std::int32_t from[kLanes];  // the first row of each in GapScratch::rows
        int lanesUsed = 0;
        std::size_t begin = 0, end = 0;  // its rows in the section
    };
    struct Motion;
    /// Batches that are visited one after the other, by the thread that has laid them out: they are
    /// in its cache. Two lines of the cache apart: halves are written to by two threads.
    struct alignas(128) Section {
        std::vector<Batch> batches;
        std::vector<Row> rows;
        std::vector<Roll> rolls;                 // of the rows; empty where none resists
        std::size_t firstBody = 0, endBody = 0;  // in bodies_: what only its rows move
        std::array<std::vector<std::int32_t>, kRowsTogether + 1> open;  // those with idle lanes
        Lanes residual = kNoLanes, squaredSpeed = kNoLanes, energy = kNoLanes;
    };

    template <class Work>
    void inHalves(const Work& work);
    void collectBodies(const GapScratch& scratch, const PairParts& parts);
    void layOut(const GapScratch& scratch, std::span<const std::size_t> pairs, Section& section);
    void schedule(const GapScratch& scratch, std::span<const std::size_t> pairs, Section& section);
    std::int32_t batchFor(std::size_t rows, std::int32_t earliest, Section& section) const;
    void extrapolateBodies(const Section& section);
    template <bool kRolls>
    void extrapolateRow(Section& section, std::size_t place) const;
    template <bool kRolls>
    void sweepUp(Section& section);
    template <bool kRolls>
    void sweepDown(Section& section);
    void begin(Section& section);
    void store(const Section& section, GapScratch& scratch) const;
    GapWork work(const Section& section, const GapScratch& scratch) const;
    static void fill(const GapScratch& scratch, Batch& batch, Section& section);
    static void fillLane(const GapScratch& scratch, Batch& batch, int lane, Section& section);
    template <bool kRolls>
    static void visit(std::size_t place, const Batch& batch, const Lanes3& u, Motion& motion,
                      Section& section);
    static Lanes resistSpin(std::size_t place, const Batch& batch, Motion& motion,
                            Section& section);
    static void applyCouple(const Batch& batch, const Lanes3& couple, Motion& motion);
    static Lanes3 velocityAt(const Row& row, const Batch& batch, const Motion& motion);
    static void apply(const Row& row, const Batch& batch, const Lanes3& change, Motion& motion);

    bool resistsRolling_ = false;
    std::vector<std::size_t> roomForParts_;
    // The bodies of the island, section by section, then what cannot be moved. Idle lanes have the
    // first, which is none.
    std::vector<LaneBody> bodies_;
    std::vector<BodyWay> ways_;
    std::vector<BodyId> idOf_;
    std::vector<std::int32_t> placeOf_;    // in bodies_, by id; 0: not there
    std::vector<std::int32_t> firstFree_;  // of each: the batch after the last that has it
    bool beginsAnew_ = true;               // the next sweep does
    double share_ = 0.0;                   // of the last way that is gone again before it, if not
    std::array<Section, 3> sections_;      // either half, and what lies across the cut
};

}  // namespace scree
