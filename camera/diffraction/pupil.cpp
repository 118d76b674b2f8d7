// SPDX-License-Identifier: Apache-2.0
#include "camera/diffraction/pupil.h"

#include <algorithm>

namespace petzval::camera {
namespace {

constexpr int kSide = 256, kPointsAcross = 4;
/// Pieces of an edge that pass or do not.
constexpr int kPieces = 32;

/// Edges of the iris that rims let through, by the share of each that passes.
std::vector<EdgeRun> passing_runs(const std::vector<std::vector<V2d>>& outline,
                                  const RimTest& passes) {
    std::vector<std::vector<V2d>> kept;
    for (const std::vector<V2d>& contour : outline) {
        size_t inside = 0;
        for (const V2d& p : contour) inside += passes(V2f(p * 0.999));
        if (inside == contour.size()) kept.push_back(contour);
    }
    std::vector<EdgeRun> out = edge_runs(kept);
    for (const std::vector<V2d>& contour : outline) {
        if (std::ranges::find(kept, contour) != kept.end()) continue;
        for (size_t i = 0; i < contour.size(); ++i) {
            const V2d from = contour[i], to = contour[(i + 1) % contour.size()];
            int passed = 0;
            for (int k = 0; k < kPieces; ++k)
                passed += passes(V2f((from + (to - from) * ((k + 0.5) / kPieces)) * 0.999));
            if (passed == 0) continue;
            const std::vector<V2d> part{from, from + (to - from) * (double(passed) / kPieces)};
            out.push_back(edge_runs({&part, 1}).front());
        }
    }
    return out;
}

}  // namespace

DiffractingPupil diffracting_pupil(const Iris& iris, const RimTest& passes) {
    DiffractingPupil out{.side = kSide};
    out.cell_mm = 2. * double(iris.bounding_radius_mm()) / kSide;
    out.amplitude.assign(size_t{kSide} * kSide, 0);
    const std::vector<std::vector<V2d>> outline = iris.outline_mm();
    out.has_outline = !outline.empty();
    constexpr int points = kPointsAcross * kPointsAcross;
    const double half_mm = double(iris.bounding_radius_mm());
    double stopped = 0, light = 0;
    for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column) {
            double amplitude = 0;
            for (int k = 0; k < points; ++k) {
                const V2f at(
                    float((column + (k % kPointsAcross + 0.5) / kPointsAcross) * out.cell_mm -
                          half_mm),
                    float((row + (k / kPointsAcross + 0.5) / kPointsAcross) * out.cell_mm -
                          half_mm));
                const double open = iris.transmits(at) / double(points);
                if (!(open > 0)) continue;
                if (passes && !passes(at)) {
                    stopped += open;
                    continue;
                }
                light += open;
                amplitude += std::sqrt(open / points);
            }
            out.amplitude[size_t(row) * kSide + size_t(column)] = amplitude;
        }
    out.is_whole = stopped == 0;
    out.area_mm2 = light * out.cell_mm * out.cell_mm;
    if (out.has_outline)
        out.runs = out.is_whole ? edge_runs(outline) : passing_runs(outline, passes);
    return out;
}

double contrast(const DiffractingPupil& pupil, V2d shift_mm) {
    const auto at = [&](int x, int y) {
        return x < 0 || y < 0 || x >= pupil.side || y >= pupil.side
                   ? 0.
                   : pupil.amplitude[size_t(y) * size_t(pupil.side) + size_t(x)];
    };
    const V2d shift = shift_mm / pupil.cell_mm;
    if (!(shift.length() < 2 * pupil.side)) return 0;
    const int dx = int(std::floor(shift.x)), dy = int(std::floor(shift.y));
    const double u = shift.x - dx, v = shift.y - dy;
    double sum = 0, whole = 0;
    for (int y = 0; y < pupil.side; ++y)
        for (int x = 0; x < pupil.side; ++x) {
            const double a = at(x, y);
            whole += a * a;
            const double below = (1 - u) * at(x + dx, y + dy) + u * at(x + dx + 1, y + dy),
                         above = (1 - u) * at(x + dx, y + dy + 1) + u * at(x + dx + 1, y + dy + 1);
            sum += a * ((1 - v) * below + v * above);
        }
    return whole > 0 ? sum / whole : 0;
}

}  // namespace petzval::camera
