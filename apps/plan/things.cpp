// SPDX-License-Identifier: Apache-2.0
#include "apps/plan/things.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/light/emission.h"
#include "core/sampling/sampler.h"

namespace petzval {
namespace {

constexpr size_t kMostClusters = 32;  ///< of each kind
constexpr size_t kMostTriangles = 1 << 18;
constexpr int kTexturePoints = 1 << 18, kSkyDirections = 4096;
/// Times the mean from which a part of a picture is a light of its own.
constexpr double kBright = 16;
constexpr double kDim = 0.01;  ///< times the brightest lamp: what is not looked for

/// A triangle, or a bright point of one.
struct Part {
    Box3f box;
    double area_m2 = 0, flux = 0;  ///< flux: luminance times area
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

/// Clusters of parts: the largest is halved until there are enough.
std::vector<std::vector<Part>> clusters_of(std::vector<Part> parts) {
    std::vector<std::vector<Part>> clusters, whole;
    if (!parts.empty()) clusters.push_back(std::move(parts));
    while (!clusters.empty() && clusters.size() + whole.size() < kMostClusters) {
        const auto largest = std::max_element(
            clusters.begin(), clusters.end(),
            [](const auto& a, const auto& b) { return longest(box_of(a)) < longest(box_of(b)); });
        auto [a, b] = halved(*largest);
        if (a.empty() || b.empty()) {
            whole.push_back(std::move(*largest));
            clusters.erase(largest);
            continue;
        }
        *largest = std::move(a);
        clusters.push_back(std::move(b));
    }
    clusters.insert(clusters.end(), std::make_move_iterator(whole.begin()),
                    std::make_move_iterator(whole.end()));
    return clusters;
}

/// Parts without those that are dim beside the brightest.
std::vector<Part> bright_ones(std::vector<Part> parts) {
    const auto light = [](const Part& p) { return p.area_m2 > 0 ? p.flux / p.area_m2 : 0; };
    double most = 0;
    for (const Part& part : parts) most = std::max(most, light(part));
    std::erase_if(parts, [&](const Part& part) { return light(part) < kDim * most; });
    return parts;
}

void add_things(std::vector<Thing>& out, Thing::Kind kind, std::vector<Part> parts) {
    for (const std::vector<Part>& cluster : clusters_of(std::move(parts))) {
        const Box3f box = box_of(cluster);
        Thing thing{kind, box.center(), box.size().length() / 2};
        double flux = 0;
        for (const Part& part : cluster) {
            thing.area_m2 += part.area_m2 / 2;
            flux += part.flux / 2;
        }
        if (thing.area_m2 > 0) thing.radiance = flux / thing.area_m2;
        out.push_back(thing);
    }
}

const Material& material_of(const Scene& scene, const Instance& instance) {
    return scene.materials[scene.meshes[instance.mesh].material];
}

bool depends_on_wavelength(const Scene& scene, const Instance& instance) {
    const Material& m = material_of(scene, instance);
    return (m.glass && m.refracts()) || (m.metal >= 0 && m.metallic > 0) ||
           (m.emits() && m.illuminant >= 0);
}

Part part_of(const Scene& scene, uint32_t instance, uint32_t triangle) {
    Part part;
    const auto corners = triangle_corners(scene, instance, triangle);
    for (const V3f& corner : corners) part.box.extendBy(corner);
    const V3f cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    part.area_m2 = double(cross.length()) / 2;
    return part;
}

double luminance_at(const Scene& scene, uint32_t instance, uint32_t triangle, V2f b) {
    return std::max(double(luminance(emitted_radiance(scene, instance, triangle, b, true))),
                    double(luminance(emitted_radiance(scene, instance, triangle, b, false))));
}

/// Bright points of a textured triangle, each as a part of the area that it stands for.
void add_bright_points(const Scene& scene, uint32_t instance, uint32_t triangle, const Part& whole,
                       int points, std::vector<Part>& bright) {
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
                              point.light * area_m2});
        }
}

void add_surfaces(const Scene& scene, std::vector<Thing>& out) {
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
    const auto stride = [](size_t count) {
        return static_cast<uint32_t>(1 + count / kMostTriangles);
    };
    const int points =
        kTexturePoints / static_cast<int>(std::clamp<size_t>(textured, 1, kTexturePoints));
    for (uint32_t k = 0; k < scene.instances.size(); ++k) {
        const Instance& i = scene.instances[k];
        const bool lamp = emits(scene, i), spectral = depends_on_wavelength(scene, i);
        if (!lamp && !spectral) continue;
        const uint32_t step = stride(lamp ? emissive + textured : other);
        for (uint32_t t = 0; t < triangles(i); t += step) {
            Part part = part_of(scene, k, t);
            part.area_m2 *= step;
            if (spectral) wavelength.push_back(part);
            if (!lamp) continue;
            part.flux = part.area_m2 * luminance_at(scene, k, t, V2f(1.f / 3));
            if (has_picture(i))
                add_bright_points(scene, k, t, part, points, bright);
            else
                lamps.push_back(part);
        }
    }
    add_things(out, Thing::Kind::Wavelength, std::move(wavelength));
    add_things(out, Thing::Kind::Lamp, bright_ones(std::move(lamps)));
    add_things(out, Thing::Kind::Lamp, std::move(bright));
}

// The sky's sampler draws in proportion to what is above the mean: what is drawn and far above it
// is a sun.
void add_sky(const Scene& scene, std::vector<Thing>& out) {
    const Sky& sky = scene.sky;
    if (sky.black() || sky.even()) return;
    std::vector<Part> bright;
    for (int i = 0; i < kSkyDirections; ++i) {
        const auto index = static_cast<uint32_t>(i);
        const V2f u(float(sobol_0(index) >> 8) * 0x1p-24f, float(sobol_1(index) >> 8) * 0x1p-24f);
        const Sky::Draw drawn = sky.sample(u);
        const Sky::Found found = sky.find(drawn.place);
        const double light = double(luminance(found.radiance));
        if (!(found.pdf > 0) || light < kBright * double(sky.average_luminance())) continue;
        const double sr = 1 / (double(found.pdf) * kSkyDirections);
        bright.push_back({Box3f(drawn.direction, drawn.direction), 2 * sr, light * 2 * sr});
    }
    const size_t first = out.size();
    add_things(out, Thing::Kind::Lamp, std::move(bright));
    for (size_t i = first; i < out.size(); ++i) {
        out[i].at_infinity = true;
        out[i].centre = unit(out[i].centre);
        out[i].radius_m += static_cast<float>(std::sqrt(out[i].area_m2 / double(kPi)));
    }
}

}  // namespace

std::vector<Thing> things_of(const Scene& scene) {
    std::vector<Thing> out;
    add_surfaces(scene, out);
    add_sky(scene, out);
    return out;
}

}  // namespace petzval
