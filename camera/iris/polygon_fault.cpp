// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <tuple>

#include "camera/iris/aperture.h"

namespace petzval::camera {
namespace {

std::string text_of(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

struct Edge {
    V2d a, b;
    size_t contour, vertex;  ///< indices of a
    [[nodiscard]] auto place() const { return std::tie(contour, vertex); }
};

int side_of(const Edge& e, const V2d& p) {
    const double cross = (e.b - e.a).cross(p - e.a);
    return (cross > 0) - (cross < 0);
}

// Whether two edges share a point. With boxes that overlap the sides alone decide.
bool meet(const Edge& e, const Edge& f) {
    const auto apart = [](double a, double b, double c, double d) {
        return std::max(a, b) < std::min(c, d) || std::max(c, d) < std::min(a, b);
    };
    if (apart(e.a.x, e.b.x, f.a.x, f.b.x) || apart(e.a.y, e.b.y, f.a.y, f.b.y)) return false;
    return side_of(e, f.a) * side_of(e, f.b) <= 0 && side_of(f, e.a) * side_of(f, e.b) <= 0;
}

PolygonFault fault(const Edge& at, const std::string& message) {
    return {at.contour, at.vertex,
            "contour " + std::to_string(at.contour + 1) + ", vertex " +
                std::to_string(at.vertex + 1) + " at (" + text_of(at.a.x) + ", " + text_of(at.a.y) +
                "): " + message};
}

std::optional<PolygonFault> find_meeting(const Polygon& polygon, std::vector<Edge> edges) {
    const auto low = [](const Edge& e) { return std::min(e.a.x, e.b.x); };
    std::sort(edges.begin(), edges.end(),
              [&](const Edge& e, const Edge& f) { return low(e) < low(f); });
    const auto follows = [&](const Edge& e, const Edge& f) {
        return e.contour == f.contour &&
               (e.vertex + 1) % polygon.contours[e.contour].size() == f.vertex;
    };
    const Edge *first = nullptr, *second = nullptr;
    for (size_t i = 0; i < edges.size(); ++i) {
        const double high = std::max(edges[i].a.x, edges[i].b.x);
        for (size_t j = i + 1; j < edges.size() && low(edges[j]) <= high; ++j) {
            const Edge *e = &edges[i], *f = &edges[j];
            if (follows(*e, *f) || follows(*f, *e) || !meet(*e, *f)) continue;
            if (f->place() < e->place()) std::swap(e, f);
            if (first && std::tie(first->contour, first->vertex, second->contour, second->vertex) <=
                             std::tie(e->contour, e->vertex, f->contour, f->vertex))
                continue;
            first = e, second = f;
        }
    }
    if (!first) return std::nullopt;
    return fault(*first, "the edge from here meets the edge from vertex " +
                             std::to_string(second->vertex + 1) + " of contour " +
                             std::to_string(second->contour + 1) +
                             "; edges must neither cross nor touch");
}

}  // namespace

std::optional<PolygonFault> find_fault(const Polygon& polygon) {
    if (polygon.contours.empty()) return PolygonFault{0, 0, "the polygon has no contour"};
    std::vector<Edge> edges;
    for (size_t c = 0; c < polygon.contours.size(); ++c) {
        const auto& contour = polygon.contours[c];
        const size_t n = contour.size();
        if (n < 3)
            return PolygonFault{c, 0,
                                "contour " + std::to_string(c + 1) + ": has " + std::to_string(n) +
                                    " vertices, and encloses nothing with fewer than 3"};
        if (edges.size() + n > kMaxPolygonVertices)
            return PolygonFault{c, 0,
                                "contour " + std::to_string(c + 1) + ": the polygon has over " +
                                    std::to_string(kMaxPolygonVertices) + " vertices; simplify it"};
        for (size_t i = 0; i < n; ++i) {
            const Edge edge{contour[i], contour[(i + 1) % n], c, i};
            if (!(std::fabs(edge.a.x) <= kMaxPolygonCoordinate &&
                  std::fabs(edge.a.y) <= kMaxPolygonCoordinate))
                return fault(edge, "coordinates must be finite and at most 1e9");
            edges.push_back(edge);
        }
        for (size_t i = edges.size() - n; i < edges.size(); ++i) {
            const V2d along = edges[i].b - edges[i].a;
            const V2d& last = contour[(edges[i].vertex + n - 1) % n];
            const V2d before = edges[i].a - last;
            if (along == V2d(0)) return fault(edges[i], "stands on the next vertex; remove one");
            if (side_of({last, edges[i].a, 0, 0}, edges[i].b) == 0 && before.dot(along) < 0)
                return fault(edges[i], "the contour turns back on itself and encloses nothing");
        }
    }
    return find_meeting(polygon, std::move(edges));
}

std::optional<std::string> find_fault(const Mask& mask) {
    constexpr int most = 8192;
    if (mask.width < 1 || mask.height < 1 || mask.width > most || mask.height > most ||
        mask.texels.size() != static_cast<size_t>(mask.width) * mask.height)
        return "the mask must have from 1 x 1 to " + std::to_string(most) + " x " +
               std::to_string(most) + " texels";
    for (size_t i = 0; i < mask.texels.size(); ++i)
        if (!(mask.texels[i] >= 0 && mask.texels[i] <= 1))
            return "column " + std::to_string(i % mask.width) + ", row " +
                   std::to_string(i / mask.width) + ": a transmission must be a number from 0 to 1";
    if (std::none_of(mask.texels.begin(), mask.texels.end(), [](float t) { return t > 0; }))
        return "the mask is black everywhere and lets no light through";
    return std::nullopt;
}

}  // namespace petzval::camera
