// SPDX-License-Identifier: Apache-2.0
#include "core/light/small_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/light/light_sampling.h"
#include "core/light/sun_disc.h"
#include "core/sampling/sampler.h"
#include "core/scene/motion.h"

namespace petzval {
namespace {

constexpr size_t kMostTriangles = 1 << 18;
constexpr int kTexturePoints = 1 << 18, kSkyDirections = 4096;
/// Times the mean from which a part of a texture is a light of its own.
constexpr double kBright = 16;
/// Lamps of a class shine at most so many times as bright as each other; the last class has all
/// that are darker. A bright lamp that nobody sees must not hide those that are seen.
constexpr double kClassRatio = 100;
constexpr size_t kClasses = 4;
/// Share of its box's surface from which on a body is one thing, however many triangles it has: a
/// ball has half.
constexpr double kCompact = 0.4;
/// Times the mean up to which the brightness of a body counts as even.
constexpr double kEven = 4;

/// A triangle, a body, or a bright point.
struct Part {
    Box3f box;
    double area_m2 = 0, flux = 0;  ///< flux: luminance times area
    float reach_m = 0;             ///< from the box's centre to the farthest point

    [[nodiscard]] double light() const { return area_m2 > 0 ? flux / area_m2 : 0; }
};

Box3f box_of(const std::vector<Part>& parts) {
    Box3f box;
    for (const Part& part : parts) box.extendBy(part.box);
    return box;
}

double longest(const Box3f& box) {
    const V3f size = box.size();
    return double(std::max({size.x, size.y, size.z}));
}

/// Halves of a cluster about the middle of its longest axis, by the parts' centres.
std::array<std::vector<Part>, 2> halved(const std::vector<Part>& parts) {
    const Box3f box = box_of(parts);
    const auto axis = static_cast<int>(box.majorAxis());
    const float middle = box.center()[axis];
    std::array<std::vector<Part>, 2> out;
    for (const Part& part : parts) out[part.box.center()[axis] > middle].push_back(part);
    return out;
}

/// All parts as one.
Part sum_of(const std::vector<Part>& parts) {
    Part out{box_of(parts)};
    for (const Part& part : parts) {
        out.area_m2 += part.area_m2;
        out.flux += part.flux;
        const float apart_m = (part.box.center() - out.box.center()).length();
        out.reach_m = std::max(out.reach_m, apart_m + part.reach_m);
    }
    return out;
}

/// Whether parts fill the surface of their box, each about as bright as the others.
bool is_compact(const std::vector<Part>& parts) {
    const Part all = sum_of(parts);
    const V3f size = all.box.size();
    const double surface = 2 * double(size.x * size.y + size.y * size.z + size.z * size.x);
    return all.area_m2 >= kCompact * surface &&
           std::all_of(parts.begin(), parts.end(),
                       [&](const Part& p) { return p.light() <= kEven * all.light(); });
}

/// Parts that are one thing, and the longest side of the box around them.
struct Cluster {
    std::vector<Part> parts;
    double longest_m;

    explicit Cluster(std::vector<Part> of)
        : parts(std::move(of)), longest_m(longest(box_of(parts))) {}
};

/// Clusters of parts: the largest is halved until there are enough.
std::vector<Cluster> clusters_of(std::vector<Part> parts, size_t most) {
    std::vector<Cluster> clusters, whole;
    if (!parts.empty()) clusters.emplace_back(std::move(parts));
    while (!clusters.empty() && clusters.size() + whole.size() < most) {
        const auto largest = std::max_element(
            clusters.begin(), clusters.end(),
            [](const Cluster& a, const Cluster& b) { return a.longest_m < b.longest_m; });
        auto [a, b] = halved(largest->parts);
        if (a.empty() || b.empty()) {
            whole.push_back(std::move(*largest));
            clusters.erase(largest);
            continue;
        }
        *largest = Cluster(std::move(a));
        clusters.emplace_back(std::move(b));
    }
    clusters.insert(clusters.end(), std::make_move_iterator(whole.begin()),
                    std::make_move_iterator(whole.end()));
    return clusters;
}

void add_features(std::vector<SmallFeature>& out, SmallFeature::Kind kind, std::vector<Part> parts,
                  size_t most) {
    for (const Cluster& cluster : clusters_of(std::move(parts), most)) {
        const Part all = sum_of(cluster.parts);
        out.push_back({kind, all.box.center(), all.box.size().length() / 2, all.reach_m, false,
                       all.area_m2 / 2, all.light()});
    }
}

/// Parts that shine, apart by how bright they are.
std::array<std::vector<Part>, kClasses> classes_of(const std::vector<Part>& parts) {
    double most = 0;
    for (const Part& part : parts) most = std::max(most, part.light());
    std::array<std::vector<Part>, kClasses> classes;
    for (const Part& part : parts) {
        if (!(part.light() > 0)) continue;
        const double darker = std::log(most / part.light()) / std::log(kClassRatio);
        classes[static_cast<size_t>(std::min(double(kClasses - 1), darker))].push_back(part);
    }
    return classes;
}

const Material& material_of(const Scene& scene, const Instance& instance) {
    return scene.materials[scene.meshes[instance.mesh].material];
}

bool depends_on_wavelength(const Scene& scene, const Instance& instance) {
    const Material& m = material_of(scene, instance);
    return (m.glass && m.refracts()) || (m.metal >= 0 && m.metallic > 0) || m.reflectance >= 0 ||
           m.iridescence > 0 || (m.emits() && m.illuminant >= 0);
}

Part part_of(const Scene& scene, uint32_t instance, uint32_t triangle) {
    Part part;
    // What moves is a thing as large as where it comes while the shutter is open.
    std::vector<V3f> reached;
    const size_t steps = step_count(scene, instance);
    for (size_t i = 0; i < steps; ++i) {
        const auto corners = triangle_corners(scene, instance, triangle, step_time(i, steps));
        const V3f cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        part.area_m2 = std::max(part.area_m2, double(cross.length()) / 2);
        reached.insert(reached.end(), corners.begin(), corners.end());
    }
    for (const V3f& corner : reached) part.box.extendBy(corner);
    for (const V3f& corner : reached)
        part.reach_m = std::max(part.reach_m, (corner - part.box.center()).length());
    return part;
}

double luminance_at(const Scene& scene, uint32_t instance, uint32_t triangle, V2f b) {
    return std::max(double(luminance(emitted_radiance(scene, instance, triangle, b, true))),
                    double(luminance(emitted_radiance(scene, instance, triangle, b, false))));
}

/// Mean luminance of a textured triangle, nits. Adds its bright points, each as a part of the area
/// that it stands for.
double add_bright_points(const Scene& scene, uint32_t instance, uint32_t triangle,
                         const Part& whole, int points, std::vector<Part>& bright) {
    const int side = std::max(2, static_cast<int>(std::sqrt(double(points))));
    const auto corners = triangle_corners(scene, instance, triangle);
    struct Point {
        V3f at;
        double light;
    };
    std::vector<Point> found;
    double sum = 0;
    for (int j = 0; j < side; ++j)
        for (int i = 0; i + j < side; ++i) {
            const V2f b((float(i) + 1.f / 3) / float(side), (float(j) + 1.f / 3) / float(side));
            found.push_back({corners[0] * (1 - b.x - b.y) + corners[1] * b.x + corners[2] * b.y,
                             luminance_at(scene, instance, triangle, b)});
            sum += found.back().light;
        }
    const auto count = static_cast<double>(found.size());
    const auto cell_m = static_cast<float>(std::sqrt(whole.area_m2 / count) / 2);
    for (const Point& point : found)
        if (point.light > kBright * sum / count) {
            const double area_m2 = whole.area_m2 / count;
            bright.push_back({Box3f(point.at - V3f(cell_m), point.at + V3f(cell_m)), area_m2,
                              point.light * area_m2, 1.5f * cell_m});
        }
    return sum / count;
}

/// Adds the parts of a body: as one, where they are compact.
void add_body(std::vector<Part>& out, const std::vector<Part>& parts) {
    if (!parts.empty() && is_compact(parts))
        out.push_back(sum_of(parts));
    else
        out.insert(out.end(), parts.begin(), parts.end());
}

/// Every n-th of the triangles of a scene, so that at most kMostTriangles are taken.
class Stride {
  public:
    explicit Stride(size_t count) : step_(1 + count / kMostTriangles) {}
    /// Whether the next triangle is taken.
    [[nodiscard]] bool next() { return next_++ % step_ == 0; }
    /// Triangles that a taken one stands for.
    [[nodiscard]] double step() const { return static_cast<double>(step_); }

  private:
    size_t step_, next_ = 0;
};

void add_surfaces(const Scene& scene, std::vector<SmallFeature>& out, size_t most) {
    size_t emissive = 0, textured = 0, other = 0;
    const auto triangles = [&](const Instance& i) { return scene.meshes[i.mesh].triangles.size(); };
    const auto has_picture = [&](const Instance& i) {
        return material_of(scene, i).emissive_texture.present();
    };
    for (const Instance& i : scene.instances) {
        if (emits(scene, i)) (has_picture(i) ? textured : emissive) += triangles(i);
        if (depends_on_wavelength(scene, i)) other += triangles(i);
    }
    std::vector<Part> lamps, bright, wavelength;
    Stride of_lamps(emissive + textured), of_others(other);
    const int points =
        kTexturePoints / static_cast<int>(std::clamp<size_t>(textured, 1, kTexturePoints));
    for (uint32_t k = 0; k < scene.instances.size(); ++k) {
        const Instance& i = scene.instances[k];
        const bool lamp = emits(scene, i), spectral = depends_on_wavelength(scene, i);
        if (!lamp && !spectral) continue;
        std::vector<Part> glowing, dispersing;
        for (uint32_t t = 0; t < triangles(i); ++t) {
            if (spectral && of_others.next()) {
                dispersing.push_back(part_of(scene, k, t));
                dispersing.back().area_m2 *= of_others.step();
            }
            if (!lamp || !of_lamps.next()) continue;
            Part part = part_of(scene, k, t);
            part.area_m2 *= of_lamps.step();
            const double light = has_picture(i)
                                     ? add_bright_points(scene, k, t, part, points, bright)
                                     : luminance_at(scene, k, t, V2f(1.f / 3));
            part.flux = part.area_m2 * light;
            if (light > 0) glowing.push_back(part);
        }
        add_body(lamps, glowing);
        add_body(wavelength, dispersing);
    }
    add_features(out, SmallFeature::Kind::Wavelength, std::move(wavelength), most);
    for (const std::vector<Part>& found : {lamps, bright})
        for (std::vector<Part>& of_class : classes_of(found))
            add_features(out, SmallFeature::Kind::Lamp, std::move(of_class), most);
}

// The sky's sampler draws in proportion to what is above the mean: what is drawn and far above it
// is a sun.
void add_sky(const Scene& scene, std::vector<SmallFeature>& out, size_t most) {
    const Sky& sky = scene.sky;
    if (sky.black() || sky.even()) return;
    std::vector<Part> bright;
    for (int i = 0; i < kSkyDirections; ++i) {
        const auto index = static_cast<uint32_t>(i);
        const V2f u(float(sobol_0(index) >> 8) * 0x1p-24f, float(sobol_1(index) >> 8) * 0x1p-24f);
        const Sky::Draw drawn = sky.sample(u);
        const Sky::Found found = sky.find(drawn.place);
        if (!(found.pdf > 0) || !sky.is_sun(found.radiance)) continue;
        const double sr = 1 / (double(found.pdf) * kSkyDirections);
        bright.push_back({Box3f(drawn.direction, drawn.direction), 2 * sr,
                          double(luminance(found.radiance)) * 2 * sr});
    }
    const size_t first = out.size();
    for (const std::vector<Part>& of_class : classes_of(bright)) {
        std::vector<Part> parts;
        add_body(parts, of_class);
        add_features(out, SmallFeature::Kind::Lamp, std::move(parts), most);
    }
    for (size_t i = first; i < out.size(); ++i) {
        out[i].at_infinity = true;
        out[i].centre = unit(out[i].centre);
        out[i].reach_m += static_cast<float>(std::sqrt(out[i].area_m2 / double(kPi)));
        out[i].radius_m += static_cast<float>(std::sqrt(out[i].area_m2 / double(kPi)));
    }
}

// The disc of each sun that has one, as wide as where it comes while the shutter is open.
void add_suns(const Scene& scene, std::vector<SmallFeature>& out, size_t most) {
    for (size_t i = 0; i < std::min(most, scene.sun_discs.size()); ++i) {
        const uint32_t light = scene.sun_discs[i];
        const auto& sun = std::get<SunLight>(scene.lights[light]);
        const auto disc_rad = 2 * std::asin(std::sqrt(sun.versine / 2));
        SmallFeature feature{SmallFeature::Kind::Lamp, -sun.direction};
        if (const auto* const steps = steps_of_light(scene, light))
            for (const Light& step : *steps) {
                const V3f apart = std::get<SunLight>(step).direction - sun.direction;
                feature.reach_m =
                    std::max(feature.reach_m, 2 * std::asin(std::min(1.f, apart.length() / 2)));
            }
        feature.at_infinity = true;
        feature.reach_m += disc_rad;
        feature.radius_m = feature.reach_m;
        feature.area_m2 = 2 * double(kPi) * double(sun.versine);
        feature.radiance = double(luminance(disc_radiance(sun)));
        out.push_back(feature);
    }
}

}  // namespace

std::vector<SmallFeature> small_features_of(const Scene& scene, size_t most_of_class) {
    std::vector<SmallFeature> out;
    add_surfaces(scene, out, most_of_class);
    add_sky(scene, out, most_of_class);
    add_suns(scene, out, most_of_class);
    return out;
}

}  // namespace petzval
