// The programs of the rasteriser, in GLSL 3.30. Positions are in world axes, measured from the
// camera's target so that single precision is enough wherever in the world a shot takes place.
//
// Light comes from a sun with soft shadows, from a sky above and from light thrown back below. How
// much of the sky a point sees is read off a map of heights seen from above: blurred, its mean and
// variance bound the share of the neighbourhood that is lower than the point (Chebyshev's
// inequality, as in variance shadow maps [DL06]). That darkens what lies deep in a heap and the
// ground under a body.
#pragma once

namespace scree::shader {

inline constexpr const char* kVersion = "#version 330 core\n";

/// Bodies: one instance is three rows of worldFromAsset and a look.
inline constexpr const char* kBodyVertex = R"glsl(
layout(location = 0) in vec3 assetPoint;
layout(location = 1) in vec3 assetNormal;
layout(location = 2) in vec4 row0;
layout(location = 3) in vec4 row1;
layout(location = 4) in vec4 row2;
layout(location = 5) in vec4 look;  // color, roughness
uniform mat4 clipFromWorld;
out vec3 position;
out vec3 normal;
flat out vec4 surface;

void main()
{
    vec4 point = vec4(assetPoint, 1.0);
    position = vec3(dot(row0, point), dot(row1, point), dot(row2, point));
    normal = vec3(dot(row0.xyz, assetNormal), dot(row1.xyz, assetNormal),
                  dot(row2.xyz, assetNormal));
    surface = look;
    gl_Position = clipFromWorld * vec4(position, 1.0);
}
)glsl";

/// A triangle that covers the picture, at the far end of the depth range.
inline constexpr const char* kScreenVertex = R"glsl(
uniform mat4 worldFromClip;
out vec3 position;

void main()
{
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    vec4 world = worldFromClip * vec4(corner, 1.0, 1.0);
    position = world.xyz / world.w;
    gl_Position = vec4(corner, 1.0, 1.0);
}
)glsl";

inline constexpr const char* kLineFragment = R"glsl(
out vec4 pixel;

void main() { pixel = vec4(0.09, 0.09, 0.10, 1.0); }
)glsl";

/// The mean of the points of each pixel. Squaring undoes the encoding well enough to average light.
inline constexpr const char* kResolveFragment = R"glsl(
uniform sampler2D points;
uniform int pointsPerEdge;
out vec4 pixel;

void main()
{
    ivec2 first = ivec2(gl_FragCoord.xy) * pointsPerEdge;
    vec3 sum = vec3(0.0);
    for (int y = 0; y < pointsPerEdge; ++y) {
        for (int x = 0; x < pointsPerEdge; ++x) {
            vec3 color = texelFetch(points, first + ivec2(x, y), 0).rgb;
            sum += color * color;
        }
    }
    pixel = vec4(sqrt(sum / float(pointsPerEdge * pointsPerEdge)), 1.0);
}
)glsl";

/// What bodies, planes and background share; stage.h gives the constants of the light.
inline constexpr const char* kLight = R"glsl(
uniform vec3 eye, up, toSun;
out vec4 pixel;

vec3 background(vec3 direction)
{
    float height = dot(direction, up);
    vec3 end = height > 0.0 ? kZenith : kNadir;
    return mix(end, kHorizon, exp(-3.2 * abs(height)));
}

// As film does: a toe that keeps what is deep in shadow dark, straight between, and a shoulder
// behind which no light, however bright, quite reaches white. See tonedForDisplay in stage.h.
vec3 displayed(vec3 light)
{
    vec3 c = kFilmGain * light * light / (light + kFilmToe);
    vec3 over = max(c - kFilmShoulder, 0.0) / (1.0 - kFilmShoulder);
    return min(c, kFilmShoulder) + (1.0 - kFilmShoulder) * (1.0 - exp(-over));
}

vec4 encoded(vec3 light)
{
    vec3 c = displayed(light);
    // The curve's power, from roots: never off by half a step of a byte, at a third of the cost.
    vec3 r2 = sqrt(c), r4 = sqrt(r2), r8 = sqrt(r4);
    vec3 low = 12.92 * c, high = 0.585122381 * r2 + 0.783140355 * r4 - 0.368262736 * r8;
    return vec4(mix(high, low, lessThanEqual(c, vec3(0.0031308))), 1.0);
}
)glsl";

inline constexpr const char* kBackgroundFragment = R"glsl(
in vec3 position;

void main() { pixel = encoded(background(normalize(position - eye))); }
)glsl";

inline constexpr const char* kSurfaceLight = R"glsl(
uniform sampler2DShadow shadowMap;
uniform sampler2D shadowBounds;  // least and greatest depth around a tile of the map
uniform mat4 shadowFromWorld;  // to 0 … 1 in x, y and depth
uniform float shadowTexel;     // length in the world
uniform sampler2D heights;  // moments of depth below the sky, nearby and wide around
uniform mat4 skyFromWorld;
uniform float skyDepth;    // distance from depth 0 to depth 1
uniform float bodyRadius;  // of a typical body

const float kPi = 3.14159265;

// Share of the sun that arrives. The point is lifted off the surface by what a texel of a slanted
// surface spans, so that a surface does not shade itself; nine bilinear taps make the edge soft.
float sunShare(vec3 point, vec3 n, float facing)
{
    if (facing <= 0.0) return 0.0;
    float slant = sqrt(1.0 - min(facing * facing, 1.0));
    vec3 lifted = point + n * shadowTexel * (0.6 + 1.9 * slant);
    vec3 s = (shadowFromWorld * vec4(lifted, 1.0)).xyz;
    vec2 tap = 1.5 / vec2(textureSize(shadowMap, 0));
    s.z = clamp(s.z, 0.0, 1.0);
    vec2 map = vec2(textureSize(shadowMap, 0)), at = floor(s.xy * map / 8.0);
    bool isInside = all(greaterThanEqual(s.xy, vec2(0.0))) && all(lessThan(s.xy, vec2(1.0)));
    vec2 bounds = isInside ? texelFetch(shadowBounds, ivec2(at), 0).xy : vec2(1.0);
    bool isLit = s.z <= bounds.x, isDark = s.z > bounds.y;

    // Where all texels around agree, or the corners do, there is no edge. A loop without rounds is
    // the only branch a software rasteriser really leaves out.
    int first = isLit || isDark ? 0 : 4;
    float corners = 0.0;
    for (int i = 0; i < first; ++i) {
        vec2 offset = vec2(2 * (i & 1) - 1, (i & 2) - 1);
        corners += texture(shadowMap, vec3(s.xy + tap * offset, s.z));
    }
    int rest = corners == 0.0 || corners == 4.0 ? 0 : 5;
    float inside = 0.0;
    for (int i = 0; i < rest; ++i) {
        vec2 offset = i == 4 ? vec2(0.0) : (i < 2 ? vec2(2 * i - 1, 0.0) : vec2(0.0, 2 * i - 5));
        inside += texture(shadowMap, vec3(s.xy + tap * offset, s.z));
    }
    return isLit ? 1.0 : (corners + inside) / float(4 + rest);
}

// Upper bound of the share of the neighbourhood that is not above the point; `gap` is how far.
float openShare(vec2 moments, float depth, out float gap)
{
    float below = min(depth, 1.0) - moments.x;
    gap = max(below, 0.0) * skyDepth / bodyRadius;
    float least = 0.04 * bodyRadius / skyDepth;
    float variance = max(moments.y - moments.x * moments.x, least * least);
    return below <= 0.0 ? 1.0 : variance / (variance + below * below);
}

// Nearby cover counts less the higher it is; wide cover counts in full.
float skyShare(vec3 point, vec3 n)
{
    vec3 s = (skyFromWorld * vec4(point + 0.35 * bodyRadius * n, 1.0)).xyz;
    float nearGap, wideGap;
    vec4 moments = texture(heights, s.xy);
    float nearCover = 1.0 - openShare(moments.xy, s.z, nearGap);
    float wideCover = 1.0 - openShare(moments.zw, s.z, wideGap);
    return (1.0 - 0.8 * nearCover / (1.0 + 0.3 * nearGap * nearGap)) * (1.0 - 0.85 * wideCover);
}

// Microfacet highlight of a surface that reflects 4 % at right angles.
float highlight(vec3 n, vec3 v, float facing, float roughness)
{
    vec3 h = normalize(v + toSun);
    float alpha = max(roughness * roughness, 0.02), a2 = alpha * alpha;
    float nh = max(dot(n, h), 0.0), nv = max(dot(n, v), 0.05), vh = max(dot(v, h), 0.0);
    float lobe = nh * nh * (a2 - 1.0) + 1.0;
    float distribution = a2 / (kPi * lobe * lobe);
    float k = 0.5 * alpha;
    float masking = 0.25 / ((nv * (1.0 - k) + k) * (facing * (1.0 - k) + k));
    float away = 1.0 - vh, away2 = away * away;
    float fresnel = 0.04 + 0.96 * away2 * away2 * away;
    return min(distribution * masking * fresnel, 4.0);
}

vec3 shaded(vec3 point, vec3 n, vec3 albedo, float roughness)
{
    vec3 v = normalize(eye - point);
    float facing = max(dot(n, toSun), 0.0);
    float sun = facing * sunShare(point, n, facing);
    float sky = skyShare(point, n);
    vec3 ambient = mix(kGroundLight, kSkyLight, 0.5 + 0.5 * dot(n, up)) * sky;
    float grazing = 0.04 + 0.5 * pow(1.0 - max(dot(n, v), 0.0), 4.0);
    vec3 mirrored = background(reflect(-v, n)) * grazing * (1.0 - roughness) * sky;
    return albedo * (sun * kSun + ambient) + mirrored +
           kSun * sun * highlight(n, v, facing, roughness);
}
)glsl";

inline constexpr const char* kBodyFragment = R"glsl(
in vec3 position;
in vec3 normal;
flat in vec4 surface;

void main()
{
    vec3 n = normalize(gl_FrontFacing ? normal : -normal);
    pixel = encoded(shaded(position, n, surface.rgb, surface.a));
}
)glsl";

/// An infinite plane: lines to judge distances by, and haze that hides where drawing ends.
inline constexpr const char* kPlaneFragment = R"glsl(
in vec3 position;
in vec3 normal;
flat in vec4 surface;
uniform vec3 gridU, gridV;  // along the plane, 1 / distance between lines long
uniform vec2 gridOrigin;
uniform vec2 haze;          // distances from the eye where it begins and is complete

// 1 on a line, averaged over the pixel, vanishing where lines would be closer than pixels.
float lines(vec2 cell, float halfWidth)
{
    vec2 blur = max(fwidth(cell), 1e-6);
    vec2 offLine = abs(fract(cell - 0.5) - 0.5);
    vec2 ink = clamp((halfWidth + blur - offLine) / blur, 0.0, 1.0) *
               min(2.0 * halfWidth / blur, 1.0) * clamp(1.5 - 3.0 * blur, 0.0, 1.0);
    return max(ink.x, ink.y);
}

void main()
{
    vec3 n = normalize(normal);
    vec2 cell = vec2(dot(position, gridU), dot(position, gridV)) + gridOrigin;
    float ink = max(0.5 * lines(cell, 0.010), lines(cell / 5.0, 0.0035));
    vec3 light = shaded(position, n, surface.rgb * (1.0 - 0.22 * ink), surface.a);
    vec3 toPoint = position - eye;
    float hazy = smoothstep(haze.x, haze.y, length(toPoint));
    pixel = encoded(mix(light, background(normalize(toPoint)), hazy));
}
)glsl";

}  // namespace scree::shader
