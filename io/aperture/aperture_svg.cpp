// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <pugixml.hpp>

#include "io/aperture/aperture_file.h"
#include "io/aperture/svg_path.h"
#include "io/base/error.h"
#include "io/file/read_file.h"
#include "io/file/text_lines.h"

namespace petzval::io {
namespace {

constexpr size_t kMaxBytes = 4 << 20;

constexpr std::array<std::pair<std::string_view, double>, 6> kUnits = {
    {{"px", 1}, {"mm", 96 / 25.4}, {"cm", 96 / 2.54}, {"in", 96}, {"pt", 96 / 72.}, {"pc", 16}}};

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::string_view name_of(const pugi::xml_node& node) {
    std::string_view name = node.name();
    if (name.starts_with("svg:")) name.remove_prefix(4);
    return name;
}

class SvgFile {
  public:
    explicit SvgFile(const std::filesystem::path& path) : file_(path.string()) {
        FileBytes read = read_file(path);
        if (!read.error.empty()) throw InputError(file_, "", read.error);
        bytes_ = std::move(read.bytes);
        if (bytes_.size() > kMaxBytes)
            throw InputError(file_, "", "has {} bytes, and an aperture may have {}; simplify it",
                             bytes_.size(), kMaxBytes);
        const auto result = document_.load_buffer(bytes_.data(), bytes_.size());
        if (!result)
            throw InputError(file_, line_at(result.offset), "is no XML: {}", result.description());
        if (name_of(document_.document_element()) != "svg")
            throw InputError(file_, "", "is no SVG; its first element must be svg");
    }

    [[nodiscard]] camera::Polygon polygon() const {
        const pugi::xml_node shape = find_shape();
        svg::Outline outline = outline_of(shape);
        const Imath::M33d matrix = matrix_of(shape);
        for (svg::Subpath& subpath : outline) {
            subpath.start *= matrix;
            for (svg::Cubic& curve : subpath.curves)
                curve.a *= matrix, curve.b *= matrix, curve.end *= matrix;
        }
        camera::Polygon polygon{flatten(outline), is_even_odd(shape)};
        if (const auto fault = camera::find_fault(polygon))
            throw InputError(file_, place(shape).place, fault->message);
        const V2d centre = centre_of(polygon);
        for (auto& contour : polygon.contours)
            for (V2d& p : contour) p = {p.x - centre.x, centre.y - p.y};  // SVG's y points down
        return polygon;
    }

  private:
    [[nodiscard]] std::string line_at(ptrdiff_t offset) const {
        const auto end = bytes_.begin() + std::clamp<ptrdiff_t>(offset, 0, std::ssize(bytes_));
        return fmt::format("line {}", 1 + std::count(bytes_.begin(), end, '\n'));
    }
    [[nodiscard]] TextPlace place(const pugi::xml_node& node, const char* attribute = "") const {
        return {file_, fmt::format("{}, {}{}{}", line_at(node.offset_debug()), node.name(),
                                   *attribute ? "/" : "", attribute)};
    }
    [[noreturn]] void refuse(const pugi::xml_node& node, const std::string& message) const {
        throw InputError(file_, place(node).place, message);
    }

    // Node by node in the order of the file, without recursion: groups may be nested at will.
    [[nodiscard]] pugi::xml_node find_shape() const {
        pugi::xml_node shape;
        const pugi::xml_node root = document_.document_element();
        for (pugi::xml_node node = root.first_child(); node && node != root;) {
            const std::string_view name = name_of(node);
            if (is_one_of(name, {"path", "polygon", "circle", "ellipse", "rect"})) {
                if (shape)
                    refuse(node, fmt::format("is a second shape after the {} of {}; combine both "
                                             "into one path",
                                             shape.name(), line_at(shape.offset_debug())));
                shape = node;
            } else if (is_one_of(name, {"line", "polyline", "text", "image", "use", "svg",
                                        "foreignObject"})) {
                refuse(node, "cannot be an aperture; draw it as one path");
            }
            const bool drawn = !is_one_of(
                name, {"defs", "clipPath", "mask", "pattern", "symbol", "marker", "metadata"});
            if (drawn && node.first_child()) {
                node = node.first_child();
                continue;
            }
            while (node != root && !node.next_sibling()) node = node.parent();
            if (node != root) node = node.next_sibling();
        }
        if (!shape)
            throw InputError(file_, "", "has no path, polygon, circle, ellipse or rect; draw one");
        if (property(shape, "fill") == "none")
            refuse(shape, "has no fill, and strokes are not seen; turn its stroke into a path");
        return shape;
    }

    // Property of a node: from the style attribute, else the attribute of that name, else the
    // element around it.
    [[nodiscard]] static std::string property(pugi::xml_node node, std::string_view name) {
        for (; node; node = node.parent()) {
            std::string value = node.attribute(std::string(name).c_str()).value();
            std::string_view style = node.attribute("style").value();
            while (!style.empty()) {
                const std::string_view one = style.substr(0, style.find(';'));
                style.remove_prefix(std::min(one.size() + 1, style.size()));
                const size_t colon = one.find(':');
                if (colon != one.npos && trimmed(one.substr(0, colon)) == name)
                    value = trimmed(one.substr(colon + 1));
            }
            if (!value.empty() && value != "inherit") return value;
        }
        return {};
    }
    [[nodiscard]] static bool is_even_odd(const pugi::xml_node& shape) {
        return property(shape, "fill-rule") == "evenodd";
    }

    // A length in user units, which are CSS's px: 96 to an inch (CSS Values and Units 4, 6.2).
    [[nodiscard]] double length(const pugi::xml_node& node, const char* name,
                                std::optional<double> otherwise = {}) const {
        std::string_view text = trimmed(node.attribute(name).value());
        if (text.empty() && otherwise) return *otherwise;
        double unit_px = 1;
        for (const auto& [ending, px] : kUnits) {
            if (!text.ends_with(ending)) continue;
            text.remove_suffix(ending.size());
            unit_px = px;
            break;
        }
        return unit_px * read_svg_numbers(text, 1, place(node, name))[0];
    }
    [[nodiscard]] double positive(const pugi::xml_node& node, const char* name) const {
        const double value = length(node, name);
        if (!(value > 0)) refuse(node, fmt::format("{} must be above 0", name));
        return value;
    }

    [[nodiscard]] svg::Outline outline_of(const pugi::xml_node& node) const {
        const std::string_view name = name_of(node);
        if (name == "path") return read_svg_path(node.attribute("d").value(), place(node, "d"));
        if (name == "polygon")
            return read_svg_points(node.attribute("points").value(), place(node, "points"));
        if (name == "rect") return rectangle(node);
        const bool circle = name == "circle";
        const V2d radii(positive(node, circle ? "r" : "rx"), positive(node, circle ? "r" : "ry"));
        const V2d centre(length(node, "cx", 0), length(node, "cy", 0));
        svg::Subpath round{centre + V2d(radii.x, 0), {}};
        add_ellipse_arc(round, centre, radii, 0, 0, 2 * std::numbers::pi);
        round.curves.back().end = round.start;
        return {round};
    }

    [[nodiscard]] svg::Outline rectangle(const pugi::xml_node& node) const {
        const V2d low(length(node, "x", 0), length(node, "y", 0));
        const V2d size(positive(node, "width"), positive(node, "height"));
        double rx = length(node, "rx", -1), ry = length(node, "ry", -1);
        if (rx < 0) rx = std::max(ry, 0.0);  // one of them alone stands for both
        if (ry < 0) ry = rx;
        rx = std::min(rx, size.x / 2), ry = std::min(ry, size.y / 2);
        const V2d inner_low = low + V2d(rx, ry), inner_high = low + size - V2d(rx, ry);
        const std::array<V2d, 4> centres = {V2d(inner_high.x, inner_low.y), inner_high,
                                            V2d(inner_low.x, inner_high.y), inner_low};
        svg::Subpath out{{inner_low.x, low.y}, {}};
        for (int i = 0; i < 4; ++i) {
            const double from = (i - 1) * std::numbers::pi / 2;
            const V2d start = centres[i] + V2d(rx * std::cos(from), ry * std::sin(from));
            out.curves.push_back({start, start, start, true});
            if (rx > 0 && ry > 0)
                add_ellipse_arc(out, centres[i], {rx, ry}, 0, from, std::numbers::pi / 2);
        }
        return {out};
    }

    [[nodiscard]] Imath::M33d matrix_of(pugi::xml_node node) const {
        Imath::M33d all;
        for (; node && name_of(node) != "svg"; node = node.parent())
            if (const auto text = node.attribute("transform"))
                all *= read_svg_transform(text.value(), place(node, "transform"));
        return all;
    }

    [[nodiscard]] V2d centre_of(const camera::Polygon& polygon) const {
        const pugi::xml_node root = document_.document_element();
        if (const auto box = root.attribute("viewBox")) {
            const auto v = read_svg_numbers(box.value(), 4, place(root, "viewBox"));
            return {v[0] + v[2] / 2, v[1] + v[3] / 2};
        }
        Imath::Box<V2d> box;
        for (const auto& contour : polygon.contours)
            for (const V2d& p : contour) box.extendBy(p);
        return box.center();
    }

    std::string file_;
    std::vector<uint8_t> bytes_;
    pugi::xml_document document_;
};

}  // namespace

camera::Polygon read_svg_aperture(const std::filesystem::path& path) {
    return SvgFile(path).polygon();
}

}  // namespace petzval::io
