// SPDX-License-Identifier: Apache-2.0
#include "io/lens/lens_drawing.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/xml_text.h"
#include "io/file/atomic_file.h"

namespace petzval::io {
namespace {

struct Bounds {
    double left = 0, right = 0, top = 0;  // as far below the axis as above

    void add(double z, double height) {
        left = std::min(left, z);
        right = std::max(right, z);
        top = std::max(top, std::abs(height));
    }
};

// Path data of an outline; SVG's y points down. 0 - h: no -0.0000.
std::string path_data(const camera::Outline& points, bool closed) {
    std::string out;
    for (const auto& [z, height] : points)
        out += fmt::format("{}{:.4f} {:.4f}", out.empty() ? "M" : "L", z, 0 - height);
    return out + (closed ? "Z" : "");
}

std::string path_element(const std::string& attributes, const camera::Outline& points,
                         bool closed = false) {
    return fmt::format("<path {} d=\"{}\"/>\n", attributes, path_data(points, closed));
}

Bounds bounds_of(const camera::Lens& lens, const LensDrawing& drawing) {
    Bounds out;
    out.add(drawing.film_mm, drawing.film_radius_mm);
    for (int i = 0; i < lens.size(); ++i)
        for (const auto& [z, height] : camera::surface_outline(lens, i, drawing.section))
            out.add(z, height);
    // Rays may come from far to the side: only points within 1.5 times the lens's height count.
    const double most = 1.5 * out.top;
    for (const SvgRay& ray : drawing.rays)
        for (const auto& [z, height] : ray.path)
            if (std::abs(height) < most) out.add(z, height);
    const double margin = 0.04 * (out.right - out.left + out.top);
    return {out.left - margin, out.right + margin, out.top + margin};
}

std::string stop_paths(const camera::Lens& lens) {
    const double z = lens.vertex_mm(lens.stop());
    const double edge =
        lens.prescription().surfaces[static_cast<size_t>(lens.stop())].semi_diameter_mm;
    const auto blade = [&](double sign) {
        return path_data({{z, sign * edge}, {z, sign * 1.3 * edge}}, false);
    };
    return fmt::format("<path id=\"stop\" class=\"stop\" d=\"{}{}\"/>\n", blade(1), blade(-1));
}

}  // namespace

std::string lens_svg(const camera::Lens& lens, const LensDrawing& drawing) {
    constexpr double width_px = 1200;
    const Bounds bounds = bounds_of(lens, drawing);
    const double width = bounds.right - bounds.left, text = 0.013 * width;
    const double height = 2 * bounds.top + 2.5 * text;
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" "
        "viewBox=\"{:.4f} {:.4f} {:.4f} {:.4f}\">\n",
        width_px, width_px * height / width, bounds.left, -bounds.top, width, height);
    // A line's width in mm, for one pixel.
    const double px = width / width_px;
    out += fmt::format(
        "<style>path{{fill:none;stroke:#222;stroke-width:{:.4f}}}"
        " .glass{{fill:#9cc4e4;fill-opacity:0.45}} .ray{{stroke-width:{:.4f}}}"
        " .axis{{stroke:#888;stroke-width:{:.4f};stroke-dasharray:{:.4f} {:.4f}}}"
        " .stop,.film{{stroke-width:{:.4f}}}</style>\n",
        1.2 * px, 0.7 * px, 0.7 * px, 8 * px, 5 * px, 3 * px);
    out += fmt::format(
        "<rect x=\"{:.4f}\" y=\"{:.4f}\" width=\"{:.4f}\" height=\"{:.4f}\" fill=\"white\"/>\n",
        bounds.left, -bounds.top, width, height);
    out += path_element("class=\"axis\"", {{bounds.left, 0}, {bounds.right, 0}});
    for (int i = 0; i < lens.size(); ++i)
        if (const camera::Outline element = camera::element_outline(lens, i, drawing.section);
            !element.empty())
            out += path_element("class=\"glass\"", element, true);
    for (const SvgRay& ray : drawing.rays)
        out += path_element(fmt::format("class=\"ray\" style=\"stroke:{}\"", ray.colour), ray.path);
    for (int i = 0; i < lens.size(); ++i)
        if (i != lens.stop())
            out += path_element(fmt::format("id=\"face{}\" class=\"face\"", i),
                                camera::surface_outline(lens, i, drawing.section));
    out += stop_paths(lens);
    out += path_element("id=\"film\" class=\"film\"", {{drawing.film_mm, -drawing.film_radius_mm},
                                                       {drawing.film_mm, drawing.film_radius_mm}});
    out += fmt::format(
        "<text x=\"{:.4f}\" y=\"{:.4f}\" font-family=\"sans-serif\" font-size=\"{:.4f}\">{}"
        "</text>\n</svg>\n",
        bounds.left + text, bounds.top + 1.2 * text, text, xml_text(drawing.caption));
    return out;
}

void check_drawing(const std::filesystem::path& path) {
    if (lower(path.extension().string()) != ".svg")
        throw ArgumentError(path.string(), "", "a drawing's name must end in .svg");
    check_writable(path);
}

void write_drawing(const std::filesystem::path& path, const camera::Lens& lens,
                   const LensDrawing& drawing) {
    check_drawing(path);
    write_file_atomically(path, lens_svg(lens, drawing));
}

}  // namespace petzval::io
