// Which blocks a frame file holds, and what of a state each of them is.
#include "io/frame_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "core/base/check.h"
#include "core/base/error.h"
#include "io/file_bytes.h"
#include "io/frame_blocks.h"

namespace scree {
namespace {

void append(std::vector<double>& values, const Vec3& vector)
{
    values.insert(values.end(), {vector.x(), vector.y(), vector.z()});
}

void append(std::vector<double>& values, const Quat& q)
{
    values.insert(values.end(), {q.w(), q.x(), q.y(), q.z()});
}

Vec3 vectorAt(const std::vector<double>& values, std::size_t row)
{
    return {values[3 * row], values[3 * row + 1], values[3 * row + 2]};
}

Quat quaternionAt(const std::vector<double>& values, std::size_t row)
{
    return {values[4 * row], values[4 * row + 1], values[4 * row + 2], values[4 * row + 3]};
}

void addState(FrameEncoder& encoder, const FrameState& state)
{
    std::vector<double> position, orientation, velocity, angularMomentum;
    for (const BodyMotion& motion : state.motion) {
        append(position, motion.position);
        append(orientation, motion.orientation);
        append(velocity, motion.velocity);
        append(angularMomentum, motion.angularMomentum);
    }
    encoder.add<std::int64_t>("clock.steps", 2, {state.clock.frame, state.clock.subStep});
    encoder.add<double>("clock.frame_time_done", 1, {state.clock.frameTimeDone});
    encoder.add("body.position", 3, position);
    encoder.add("body.orientation", 4, orientation);
    encoder.add("body.velocity", 3, velocity);
    encoder.add("body.angular_momentum", 3, angularMomentum);
    encoder.add("body.order", 1, state.order);
    if (!state.bornAt.empty()) encoder.add("body.born_at", 1, state.bornAt);
}

void addStays(FrameEncoder& encoder, const std::string& name, const std::vector<BodyRest>& all,
              Stay BodyRest::*member)
{
    std::vector<std::int32_t> frames;
    std::vector<double> position, orientation;
    for (const BodyRest& rest : all) {
        const Stay& stay = rest.*member;
        frames.push_back(stay.frames);
        append(position, stay.position);
        append(orientation, stay.orientation);
    }
    encoder.add(name, 1, frames);
    encoder.add(name + "_position", 3, position);
    encoder.add(name + "_orientation", 4, orientation);
}

/// Takes of before there was such a thing begin to count anew.
void readStays(const FrameDecoder& decoder, const std::string& name, std::uint64_t bodyCount,
               std::vector<BodyRest>& all, Stay BodyRest::*member)
{
    if (decoder.rowsOf(name) == 0) return;
    const auto frames = decoder.read<std::int32_t>(name, bodyCount, 1);
    const auto position = decoder.read<double>(name + "_position", bodyCount, 3);
    const auto orientation = decoder.read<double>(name + "_orientation", bodyCount, 4);
    for (std::size_t i = 0; i < bodyCount; ++i)
        all[i].*member = {vectorAt(position, i), quaternionAt(orientation, i), frames[i]};
}

/// So it is for method `paper`, and at time zero unless bodies start asleep.
bool isNothing(const ContactMemory& memory)
{
    return memory.dt == 0.0 && memory.contacts.empty() && memory.rest.empty();
}

void addMemory(FrameEncoder& encoder, const ContactMemory& memory)
{
    if (isNothing(memory)) return;
    std::vector<std::int32_t> bodies, still, unbalanced;
    std::vector<std::int64_t> features;
    std::vector<double> place, force, couple, position, orientation, pull;
    bool anyCouple = false;
    for (const RememberedContact& contact : memory.contacts) {
        bodies.insert(bodies.end(), {contact.a, contact.b});
        features.push_back(std::bit_cast<std::int64_t>(contact.feature));
        append(place, contact.place);
        append(force, contact.force);
        append(couple, contact.couple);
        anyCouple = anyCouple || !contact.couple.isZero(0.0);
    }
    for (const BodyRest& rest : memory.rest) {
        still.insert(still.end(), {rest.still.frames, rest.isAsleep});
        unbalanced.push_back(rest.unbalancedFrames);
        append(position, rest.still.position);
        append(orientation, rest.still.orientation);
        append(pull, rest.pull);
    }
    encoder.add<double>("memory.dt", 1, {memory.dt});
    encoder.add("memory.bodies", 2, bodies);
    encoder.add("memory.feature", 1, features);
    encoder.add("memory.place", 3, place);
    encoder.add("memory.force", 3, force);
    if (anyCouple) encoder.add("memory.couple", 3, couple);
    encoder.add("rest.still", 2, still);
    encoder.add("rest.position", 3, position);
    encoder.add("rest.orientation", 4, orientation);
    encoder.add("rest.pull", 3, pull);
    if (std::ranges::any_of(unbalanced, [](std::int32_t frames) { return frames > 0; }))
        encoder.add("rest.unbalanced", 1, unbalanced);
    addStays(encoder, "rest.nearby", memory.rest, &BodyRest::nearby);
    addStays(encoder, "rest.around", memory.rest, &BodyRest::around);
}

/// Poses and velocities of one or more samples, sample after sample.
void addPoses(FrameEncoder& encoder, const std::string& prefix, std::span<const SceneFrame> samples)
{
    std::vector<double> position, orientation, velocity, angularVelocity;
    for (const SceneFrame& sample : samples) {
        for (std::size_t i = 0; i < sample.worldFromAsset.size(); ++i) {
            append(position, sample.worldFromAsset[i].position);
            append(orientation, sample.worldFromAsset[i].orientation);
            append(velocity, sample.velocity[i]);
            append(angularVelocity, sample.angularVelocity[i]);
        }
    }
    encoder.add(prefix + ".position", 3, position);
    encoder.add(prefix + ".orientation", 4, orientation);
    encoder.add(prefix + ".velocity", 3, velocity);
    encoder.add(prefix + ".angular_velocity", 3, angularVelocity);
}

/// Nothing at all when there are none, so that only takes with sub-frames pay for them.
void addBetween(FrameEncoder& encoder, std::span<const SceneFrame> between)
{
    if (between.empty()) return;
    std::vector<double> offsets;
    for (const SceneFrame& sample : between) offsets.push_back(sample.offset);
    encoder.add("sub.offset", 1, offsets);
    addPoses(encoder, "sub", between);
}

/// The whole block is left out where nobody asked for it.
void addLastStep(FrameEncoder& encoder, const std::optional<StepSeen>& step)
{
    if (!step) return;
    std::vector<std::int32_t> bodies;
    std::vector<double> point, normal, impulse;
    for (const ContactSeen& contact : step->contacts) {
        bodies.insert(bodies.end(), {contact.a, contact.b});
        append(point, contact.point);
        append(normal, contact.normal);
        append(impulse, contact.impulse);
    }
    encoder.add<double>("step.dt", 1, {step->dt});
    encoder.add("step.level", 1, step->level);
    encoder.add("step.overlap", 1, step->overlap);
    encoder.add("contact.bodies", 2, bodies);
    encoder.add("contact.point", 3, point);
    encoder.add("contact.normal", 3, normal);
    encoder.add("contact.impulse", 3, impulse);
}

void addUntold(FrameEncoder& encoder, const std::vector<BodyPair>& pairs)
{
    if (pairs.empty()) return;
    std::vector<std::int32_t> bodies;
    for (const BodyPair& pair : pairs) bodies.insert(bodies.end(), {pair.a, pair.b});
    encoder.add("untold.bodies", 2, bodies);
}

/// Visits what a checkpoint keeps of the figures of a frame, in the order in which it does; of what
/// is true at the end of a frame only, and of times, nothing.
template <class Report, class Visit>
void visitFigures(Report& frame, const Visit& visit)
{
    auto& sum = frame.sum;
    visit(frame.steps), visit(frame.shortestStep), visit(frame.longestStep);
    visit(frame.substepCapReached), visit(frame.fastestBody);
    visit(sum.dt), visit(sum.limitedBy), visit(sum.broadPairs), visit(sum.touchingPairs);
    visit(sum.contactPairs), visit(sum.contacts), visit(sum.levels), visit(sum.largestLevel);
    for (auto* impulses : {&sum.collisionImpulses, &sum.contactImpulses, &sum.shockImpulses}) {
        visit(impulses->sticking), visit(impulses->sliding), visit(impulses->fallback);
        visit(impulses->rolling), visit(impulses->rollingDropped);
    }
    visit(sum.pushes), visit(sum.loopsAtTheirCap), visit(sum.pushesCut), visit(sum.pushOutWork);
    visit(sum.deepestBeforePushOut), visit(sum.deepestAfterPushOut);
    visit(sum.worstOverlapRatio), visit(sum.worstA), visit(sum.worstB);
}

/// Nothing at all for a frame, whose figures stand in stats.jsonl.
void addSoFar(FrameEncoder& encoder, const FrameReport& soFar)
{
    if (soFar.steps == 0) return;
    std::vector<double> figures;
    visitFigures(soFar,
                 [&](const auto& figure) { figures.push_back(static_cast<double>(figure)); });
    encoder.add("so_far.figures", 1, figures);
}

/// Of figures that are no numbers of their kind none are taken: without them a run goes on as well.
FrameReport readSoFar(const FrameDecoder& decoder, std::uint64_t bodyCount)
{
    FrameReport report;
    std::size_t count = 0;
    visitFigures(report, [&](const auto&) { ++count; });
    if (decoder.rowsOf("so_far.figures") != count) return report;
    const auto figures = decoder.read<double>("so_far.figures", count, 1);
    bool areRight = true;
    const double* next = figures.data();
    visitFigures(report, [&](auto& figure) {
        using Figure = std::remove_reference_t<decltype(figure)>;
        const double value = *next++;
        if constexpr (std::is_floating_point_v<Figure>) {
            figure = value;
        } else {
            constexpr double kMost = std::is_same_v<Figure, StepLimit>
                                         ? static_cast<double>(StepLimit::substepCap)
                                         : static_cast<double>(std::numeric_limits<int>::max());
            const bool isRight =
                value >= -1.0 && value == std::floor(value) &&
                (value <= kMost || std::is_same_v<Figure, std::int64_t>)&&value < 0x1p53;
            areRight = areRight && isRight;
            if (isRight) figure = static_cast<Figure>(value);
        }
    });
    const auto most = static_cast<BodyId>(bodyCount);
    const bool areBodies =
        report.fastestBody < most && report.sum.worstA < most && report.sum.worstB < most;
    return areRight && areBodies ? report : FrameReport();
}

std::vector<BodyPair> readUntold(const FrameDecoder& decoder, std::uint64_t bodyCount)
{
    const std::uint64_t count = decoder.rowsOf("untold.bodies");
    if (count == 0) return {};
    const auto bodies = decoder.read<std::int32_t>("untold.bodies", count, 2);
    std::vector<BodyPair> pairs;
    for (std::size_t i = 0; i < count; ++i) {
        for (const std::int32_t body : {bodies[2 * i], bodies[2 * i + 1]})
            if (body < 0 || static_cast<std::uint64_t>(body) >= bodyCount)
                decoder.fail("an overlap is of body " + std::to_string(body) + " of " +
                             std::to_string(bodyCount));
        pairs.push_back({bodies[2 * i], bodies[2 * i + 1]});
    }
    return pairs;
}

/// Whether it turns and does not stretch, so far as a step keeps to that.
bool isRotation(const Quat& q)
{
    return std::abs(q.norm() - 1.0) < 1e-6;  // also false for what is no number
}

bool isRight(const Stay& stay)
{
    return stay.position.allFinite() && isRotation(stay.orientation) && stay.frames >= -1;
}

bool isRight(const BodyRest& rest)
{
    return isRight(rest.still) && isRight(rest.nearby) && isRight(rest.around) &&
           rest.pull.allFinite() && rest.unbalancedFrames >= 0;
}

/// Of what is remembered: that a step can begin with it.
void checkMemory(const FrameDecoder& decoder, const FrameState& state)
{
    const auto require = [&](bool isTrue, const std::string& otherwise) {
        if (!isTrue) decoder.fail(otherwise);
    };
    const ContactMemory& memory = state.contactMemory;
    require(std::isfinite(memory.dt) && memory.dt >= 0.0, "the last step took a time that is none");
    // The next step of a frame is no longer than the last one.
    const bool isInside = state.clock.subStep > 0 && !isNothing(memory);
    require(!isInside || memory.dt > 0.0,
            "it stands inside a frame, and its last step took no time");
    const auto bodiesOf = [](const RememberedContact& c) { return std::pair(c.a, c.b); };
    require(std::ranges::is_sorted(memory.contacts, {}, bodiesOf),
            "remembered contacts are not in order");
    for (const RememberedContact& contact : memory.contacts) {
        for (const BodyId body : {contact.a, contact.b})
            require(body >= 0 && static_cast<std::size_t>(body) < state.motion.size(),
                    "a remembered contact is of a body that does not exist");
        const std::string bodies = std::to_string(contact.a) + " and " + std::to_string(contact.b);
        require(contact.a < contact.b,
                "a remembered contact is of bodies " + bodies + ", which are not two in order");
        require(
            contact.place.allFinite() && contact.force.allFinite() && contact.couple.allFinite(),
            "a remembered contact of bodies " + bodies + " carries what is no number");
    }
    for (std::size_t i = 0; i < memory.rest.size(); ++i)
        require(isRight(memory.rest[i]),
                "body " + std::to_string(i) + " remembers a rest that cannot be");
}

/// The fields of a state are indices and numbers that a step goes by without asking: a file whose
/// checksum fits may still come from another program.
void checkState(const FrameDecoder& decoder, const FrameState& state)
{
    const auto require = [&](bool isTrue, const std::string& otherwise) {
        if (!isTrue) decoder.fail(otherwise);
    };
    require(state.clock.frame >= 0 && state.clock.subStep >= 0 &&
                std::isfinite(state.clock.frameTimeDone) && state.clock.frameTimeDone >= 0.0,
            "the clock shows a time that never was");
    std::vector<char> isThere(state.order.size(), 0);
    for (const BodyId body : state.order) {
        const bool isNew = body >= 0 && static_cast<std::size_t>(body) < isThere.size() &&
                           !isThere[static_cast<std::size_t>(body)];
        require(isNew, "the order of bodies does not name each of them once");
        isThere[static_cast<std::size_t>(body)] = 1;
    }
    for (std::size_t i = 0; i < state.motion.size(); ++i) {
        const BodyMotion& m = state.motion[i];
        require(m.position.allFinite() && m.orientation.coeffs().allFinite() &&
                    m.velocity.allFinite() && m.angularMomentum.allFinite(),
                "body " + std::to_string(i) + " moves by what is no number");
        require(isRotation(m.orientation),
                "body " + std::to_string(i) + " is turned by what is no rotation");
    }
    checkMemory(decoder, state);
}

void readState(const FrameDecoder& decoder, std::uint64_t bodyCount, FrameState& state)
{
    const auto steps = decoder.read<std::int64_t>("clock.steps", 1, 2);
    state.clock.frame = steps[0];
    state.clock.subStep = steps[1];
    state.clock.frameTimeDone = decoder.read<double>("clock.frame_time_done", 1, 1)[0];
    const auto position = decoder.read<double>("body.position", bodyCount, 3);
    const auto orientation = decoder.read<double>("body.orientation", bodyCount, 4);
    const auto velocity = decoder.read<double>("body.velocity", bodyCount, 3);
    const auto angularMomentum = decoder.read<double>("body.angular_momentum", bodyCount, 3);
    state.order = decoder.read<std::int32_t>("body.order", bodyCount, 1);
    if (decoder.rowsOf("body.born_at") > 0) {
        state.bornAt = decoder.read<std::int32_t>("body.born_at", bodyCount, 1);
    }
    state.motion.resize(bodyCount);
    for (std::size_t i = 0; i < bodyCount; ++i)
        state.motion[i] = {vectorAt(position, i), quaternionAt(orientation, i),
                           vectorAt(velocity, i), vectorAt(angularMomentum, i)};
}

void readMemory(const FrameDecoder& decoder, std::uint64_t bodyCount, ContactMemory& memory)
{
    if (decoder.rowsOf("memory.dt") == 0) return;
    memory.dt = decoder.read<double>("memory.dt", 1, 1)[0];
    const std::uint64_t contacts = decoder.rowsOf("memory.feature");
    const auto bodies = decoder.read<std::int32_t>("memory.bodies", contacts, 2);
    const auto features = decoder.read<std::int64_t>("memory.feature", contacts, 1);
    const auto place = decoder.read<double>("memory.place", contacts, 3);
    const auto force = decoder.read<double>("memory.force", contacts, 3);
    for (std::size_t i = 0; i < contacts; ++i) {
        memory.contacts.push_back({bodies[2 * i], bodies[2 * i + 1],
                                   std::bit_cast<std::uint64_t>(features[i]), vectorAt(place, i),
                                   vectorAt(force, i), Vec3::Zero()});
    }
    if (decoder.rowsOf("memory.couple") > 0) {
        const auto couple = decoder.read<double>("memory.couple", contacts, 3);
        for (std::size_t i = 0; i < contacts; ++i) memory.contacts[i].couple = vectorAt(couple, i);
    }
    if (decoder.rowsOf("rest.still") == 0) return;
    const auto still = decoder.read<std::int32_t>("rest.still", bodyCount, 2);
    const auto position = decoder.read<double>("rest.position", bodyCount, 3);
    const auto orientation = decoder.read<double>("rest.orientation", bodyCount, 4);
    const auto pull = decoder.read<double>("rest.pull", bodyCount, 3);
    memory.rest.resize(bodyCount);
    for (std::size_t i = 0; i < bodyCount; ++i) {
        BodyRest& rest = memory.rest[i];
        rest.still = {vectorAt(position, i), quaternionAt(orientation, i), still[2 * i]};
        rest.pull = vectorAt(pull, i);
        rest.isAsleep = still[2 * i + 1] != 0;
    }
    if (decoder.rowsOf("rest.unbalanced") > 0) {
        const auto unbalanced = decoder.read<std::int32_t>("rest.unbalanced", bodyCount, 1);
        for (std::size_t i = 0; i < bodyCount; ++i) memory.rest[i].unbalancedFrames = unbalanced[i];
    }
    readStays(decoder, "rest.nearby", bodyCount, memory.rest, &BodyRest::nearby);
    readStays(decoder, "rest.around", bodyCount, memory.rest, &BodyRest::around);
}

void readPoses(const FrameDecoder& decoder, const std::string& prefix, std::uint64_t bodyCount,
               std::span<SceneFrame> samples)
{
    const std::uint64_t rows = bodyCount * samples.size();
    const auto position = decoder.read<double>(prefix + ".position", rows, 3);
    const auto orientation = decoder.read<double>(prefix + ".orientation", rows, 4);
    const auto velocity = decoder.read<double>(prefix + ".velocity", rows, 3);
    const auto angularVelocity = decoder.read<double>(prefix + ".angular_velocity", rows, 3);
    for (std::size_t row = 0; row < rows; ++row) {
        SceneFrame& sample = samples[row / bodyCount];
        sample.worldFromAsset.push_back({vectorAt(position, row), quaternionAt(orientation, row)});
        sample.velocity.push_back(vectorAt(velocity, row));
        sample.angularVelocity.push_back(vectorAt(angularVelocity, row));
    }
}

/// `frame` is the number of the frame before the samples.
std::vector<SceneFrame> readBetween(const FrameDecoder& decoder, std::uint64_t bodyCount, int frame)
{
    const std::uint64_t count = decoder.rowsOf("sub.offset");
    if (count == 0) return {};
    const auto offsets = decoder.read<double>("sub.offset", count, 1);
    std::vector<SceneFrame> between(count);
    for (std::size_t i = 0; i < count; ++i) {
        between[i].frame = frame;
        between[i].offset = offsets[i];
    }
    readPoses(decoder, "sub", bodyCount, between);
    return between;
}

std::optional<StepSeen> readLastStep(const FrameDecoder& decoder, std::uint64_t bodyCount)
{
    if (decoder.rowsOf("step.dt") == 0) return {};
    StepSeen step;
    step.dt = decoder.read<double>("step.dt", 1, 1)[0];
    step.level = decoder.read<std::int32_t>("step.level", bodyCount, 1);
    step.overlap = decoder.read<double>("step.overlap", bodyCount, 1);
    const std::uint64_t count = decoder.rowsOf("contact.bodies");
    const auto bodies = decoder.read<std::int32_t>("contact.bodies", count, 2);
    const auto point = decoder.read<double>("contact.point", count, 3);
    const auto normal = decoder.read<double>("contact.normal", count, 3);
    const auto impulse = decoder.read<double>("contact.impulse", count, 3);
    for (std::size_t i = 0; i < count; ++i) {
        for (const std::int32_t body : {bodies[2 * i], bodies[2 * i + 1]})
            if (body < 0 || static_cast<std::uint64_t>(body) >= bodyCount)
                decoder.fail("a contact names body " + std::to_string(body) + " of " +
                             std::to_string(bodyCount));
        step.contacts.push_back({bodies[2 * i], bodies[2 * i + 1], vectorAt(point, i),
                                 vectorAt(normal, i), vectorAt(impulse, i)});
    }
    return step;
}

}  // namespace

std::string encodeFrame(const FrameState& state)
{
    const std::size_t bodyCount = state.motion.size();
    SCREE_CHECK(state.order.size() == bodyCount, "order and state differ in size");
    SCREE_CHECK(state.bornAt.empty() || state.bornAt.size() == bodyCount, "births differ in size");
    SCREE_CHECK(state.scene.worldFromAsset.size() == bodyCount, "scene and state differ in size");
    for (const SceneFrame& sample : state.between)
        SCREE_CHECK(sample.worldFromAsset.size() == bodyCount, "a sample lacks bodies");
    SCREE_CHECK(!state.lastStep || state.lastStep->level.size() == bodyCount, "levels lack bodies");

    FrameEncoder encoder;
    addState(encoder, state);
    addMemory(encoder, state.contactMemory);
    addPoses(encoder, "asset", {&state.scene, 1});
    addBetween(encoder, state.between);
    addLastStep(encoder, state.lastStep);
    addUntold(encoder, state.untold);
    addSoFar(encoder, state.soFar);
    FrameHeader header;
    header.frame = state.scene.frame;
    header.bodyCount = bodyCount;
    header.shotHash = state.shotHash;
    return encoder.finish(header);
}

FrameState decodeFrame(std::string_view bytes, const std::filesystem::path& path)
{
    const FrameDecoder decoder(bytes, path);
    FrameState state;
    state.shotHash = decoder.header().shotHash;
    state.scene.frame = static_cast<int>(decoder.header().frame);
    readState(decoder, decoder.header().bodyCount, state);
    readMemory(decoder, decoder.header().bodyCount, state.contactMemory);
    checkState(decoder, state);
    const std::uint64_t bodyCount = decoder.header().bodyCount;
    readPoses(decoder, "asset", bodyCount, {&state.scene, 1});
    // A frame was reached from the one before; a checkpoint stands behind the frame it left.
    const bool isInside = state.clock.subStep > 0;
    state.between = readBetween(decoder, bodyCount, state.scene.frame - (isInside ? 0 : 1));
    state.lastStep = readLastStep(decoder, bodyCount);
    state.untold = readUntold(decoder, bodyCount);
    state.soFar = readSoFar(decoder, bodyCount);
    return state;
}

FrameState readFrameFile(const std::filesystem::path& path)
{
    return decodeFrame(readFileBytes(path), path);
}

FrameState readFrameFile(const std::filesystem::path& path, int frame)
{
    FrameState state = readFrameFile(path);
    if (state.scene.frame != frame)
        throw Error(ErrorKind::inputOutput, {path.string(), 0, 0},
                    "holds frame " + std::to_string(state.scene.frame) +
                        " under the name of frame " + std::to_string(frame));
    return state;
}

}  // namespace scree
