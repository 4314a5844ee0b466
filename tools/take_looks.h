// What colours tell in the pictures of a take: materials, or what bodies do. Each kind of look has
// one scale for the whole shot, so that a colour means the same in every picture.
#pragma once

#include <string>
#include <vector>

#include "io/take_reader.h"
#include "render/camera.h"
#include "render/legend.h"
#include "render/look.h"

namespace scree {

enum class LookKind {
    shaded,     ///< the materials, each body a little different
    wireframe,  ///< the same with the edges of all triangles
    speed,      ///< how fast the origin of a body moves
    sleep,      ///< whether a body moves at all
    id,         ///< which body it is: neighbours in the list look unlike each other
    levels,     ///< how high in the contact graph it rests
    overlap,    ///< how deep it is in its deepest overlap
    contacts    ///< pale bodies, and over them contact points, normals and forces
};

/// "shaded", "wireframe", …; throws Error{usage} naming the nearest one.
LookKind parseLook(const std::string& word);

/// All words that parseLook knows: "shaded, wireframe, …".
std::string knownLooks();

class TakeLooks {
public:
    /// `take` must outlive the object. Throws Error{missingInput} when the kind needs contacts and
    /// the take has none.
    TakeLooks(const TakeReader& take, const SceneDescription& scene, LookKind kind);

    /// Parallel to the scene's bodies, as the materials say.
    const std::vector<Look>& materials() const { return materials_; }

    /// Whether looks change from frame to frame.
    bool isDiagnostic() const { return kind_ != LookKind::shaded && kind_ != LookKind::wireframe; }
    std::vector<Look> looksAt(const SceneFrame& frame) const;

    /// How far the scale of the colours and marks reaches, as ", scale 4 1"; empty where there is
    /// none.
    std::string scaleText() const;

    /// Draws the legend, and for LookKind::contacts the marks of the frame.
    void drawOver(Image& image, const Camera& camera, int frame) const;

private:
    void chooseSpeedScale();
    void chooseStepScale();
    Look lookOf(std::size_t body, const SceneFrame& frame,
                const std::optional<StepSeen>& step) const;

    const TakeReader& take_;
    LookKind kind_;
    std::vector<Look> materials_;
    std::vector<bool> isMovable_;  // parallel to materials_
    double most_ = 1.0;            // end of the scale: units per second, levels, metres or newtons
    double markLength_ = 1.0;      // of the longest force [shot's unit]
    Legend legend_;
};

}  // namespace scree
