// SPDX-License-Identifier: Apache-2.0
#include "io/aperture/svg_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "io/base/error.h"

namespace petzval::io {
namespace {

constexpr std::string_view kSpace = " \t\r\n\f";

class Reader {
  public:
    Reader(std::string_view text, const TextPlace& place) : text_(text), place_(place) {}

    [[noreturn]] void refuse(const std::string& message) const {
        throw InputError(place_.file, fmt::format("{}, character {}", place_.place, at_ + 1),
                         message);
    }
    void skip_space() { at_ = std::min(text_.find_first_not_of(kSpace, at_), text_.size()); }
    void skip_comma() {
        skip_space();
        if (peek() == ',') ++at_, skip_space();
    }
    [[nodiscard]] bool done() {
        skip_space();
        return at_ == text_.size();
    }
    [[nodiscard]] char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
    char take() { return text_[at_++]; }
    [[nodiscard]] std::string_view word() {
        const size_t from = at_;
        while (std::isalpha(static_cast<unsigned char>(peek()))) ++at_;
        return text_.substr(from, at_ - from);
    }
    void expect(char c) {
        skip_space();
        if (peek() != c) refuse(fmt::format("'{}' is missing", c));
        ++at_;
    }
    [[nodiscard]] bool number_follows() const {
        const char c = peek();
        return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+';
    }
    double number() {
        skip_comma();
        if (!number_follows()) refuse("a number is missing");
        const size_t from = at_ + (peek() == '+');
        double value = 0;
        const auto [end, error] =
            std::from_chars(text_.data() + from, text_.data() + text_.size(), value);
        if (error != std::errc() || !std::isfinite(value)) refuse("a finite number is missing");
        at_ = static_cast<size_t>(end - text_.data());
        return value;
    }
    // One character: flags may stand together, as in "a1 1 0 01 10 10".
    bool flag() {
        skip_comma();
        if (peek() != '0' && peek() != '1') refuse("a flag of an arc must be 0 or 1");
        return take() == '1';
    }

  private:
    std::string_view text_;
    const TextPlace& place_;
    size_t at_ = 0;
};

double angle_between(const V2d& a, const V2d& b) {
    return std::atan2(a.cross(b), a.dot(b));
}

// Adds an arc; endpoints to centre: SVG 2, appendix B.2.4 and B.2.5.
void add_svg_arc(svg::Subpath& to, V2d from, V2d radii, double turn_rad, bool large, bool sweep,
                 V2d end) {
    if (from == end) return;
    radii = {std::fabs(radii.x), std::fabs(radii.y)};
    if (!(radii.x > 0 && radii.y > 0)) return to.curves.push_back({from, end, end, true});
    const double c = std::cos(turn_rad), s = std::sin(turn_rad);
    const V2d half = (from - end) / 2;
    const V2d p(c * half.x + s * half.y, -s * half.x + c * half.y);
    const double lambda = std::pow(p.x / radii.x, 2) + std::pow(p.y / radii.y, 2);
    if (lambda > 1) radii *= std::sqrt(lambda);
    const double root = std::sqrt(std::max(1 / lambda - 1, 0.0)) * (large == sweep ? -1 : 1);
    const V2d centre_turned(root * radii.x * p.y / radii.y, -root * radii.y * p.x / radii.x);
    const V2d centre =
        V2d(c * centre_turned.x - s * centre_turned.y, s * centre_turned.x + c * centre_turned.y) +
        (from + end) / 2;
    const V2d first = (p - centre_turned) / radii, last = (-p - centre_turned) / radii;
    double by = angle_between(first, last);
    if (sweep && by < 0) by += 2 * std::numbers::pi;
    if (!sweep && by > 0) by -= 2 * std::numbers::pi;
    add_ellipse_arc(to, centre, radii, turn_rad, std::atan2(first.y, first.x), by);
    to.curves.back().end = end;
}

class PathReader {
  public:
    PathReader(std::string_view data, const TextPlace& place) : in_(data, place) {}

    svg::Outline read() {
        while (!in_.done()) {
            if (!in_.number_follows() && in_.peek() != ',')
                command_ = in_.take();
            else if (command_ == 'M' || command_ == 'm')
                command_ = command_ == 'M' ? 'L' : 'l';  // further pairs of a moveto are lines
            else if (command_ == 'Z' || command_ == 'z' || command_ == 0)
                in_.refuse("a command is missing");
            step();
        }
        std::erase_if(out_, [](const svg::Subpath& s) { return s.curves.empty(); });
        return std::move(out_);
    }

  private:
    V2d point() {
        const double x = in_.number();
        return base_ + V2d(x, in_.number());
    }
    svg::Subpath& subpath() {
        if (out_.empty()) in_.refuse("a path must begin with M");
        if (closed_) out_.push_back({at_, {}}), closed_ = false;
        return out_.back();
    }
    void line_to(const V2d& end) {
        subpath().curves.push_back({at_, end, end, true});
        move(end, end);
    }
    void cubic_to(const V2d& a, const V2d& b, const V2d& end) {
        subpath().curves.push_back({a, b, end});
        move(end, b);
    }
    void quadratic_to(const V2d& control, const V2d& end) {
        subpath().curves.push_back(
            {at_ + (control - at_) * (2.0 / 3), end + (control - end) * (2.0 / 3), end});
        move(end, control);
    }
    void move(const V2d& to, const V2d& control) { at_ = to, control_ = control; }
    // The control point of a smooth curve, where the command before was one of its kind.
    [[nodiscard]] V2d mirrored(std::string_view kind) const {
        return kind.find(previous_) != kind.npos ? at_ * 2.0 - control_ : at_;
    }

    void step() {
        const bool relative = command_ >= 'a';
        base_ = relative ? at_ : V2d(0);
        const char kind = relative ? static_cast<char>(command_ - 'a' + 'A') : command_;
        switch (kind) {
            case 'M': {
                const V2d start = point();
                out_.push_back({start, {}});
                closed_ = false;
                move(start, start);
                break;
            }
            case 'L':
                line_to(point());
                break;
            case 'H':
                line_to({base_.x + in_.number(), at_.y});
                break;
            case 'V':
                line_to({at_.x, base_.y + in_.number()});
                break;
            case 'C': {
                const V2d a = point(), b = point();
                cubic_to(a, b, point());
                break;
            }
            case 'S': {
                const V2d b = point();
                cubic_to(mirrored("CS"), b, point());
                break;
            }
            case 'Q': {
                const V2d control = point();
                quadratic_to(control, point());
                break;
            }
            case 'T':
                quadratic_to(mirrored("QT"), point());
                break;
            case 'A': {
                const double rx = in_.number(), ry = in_.number();
                const double turn = in_.number() * std::numbers::pi / 180;
                const bool large = in_.flag(), sweep = in_.flag();
                const V2d end = point();
                add_svg_arc(subpath(), at_, {rx, ry}, turn, large, sweep, end);
                move(end, end);
                break;
            }
            case 'Z': {
                const V2d start = subpath().start;
                move(start, start);
                closed_ = true;
                break;
            }
            default:
                in_.refuse(
                    fmt::format("'{}' is no command of a path; there are M L H V C S Q T A "
                                "Z and their small letters",
                                command_));
        }
        previous_ = kind;
    }

    Reader in_;
    svg::Outline out_;
    V2d at_{0, 0}, base_{0, 0}, control_{0, 0};
    char command_ = 0, previous_ = ' ';
    bool closed_ = false;
};

}  // namespace

svg::Outline read_svg_path(std::string_view data, const TextPlace& place) {
    return PathReader(data, place).read();
}

svg::Outline read_svg_points(std::string_view points, const TextPlace& place) {
    Reader in(points, place);
    svg::Outline out;
    while (!in.done()) {
        const double x = in.number();
        const V2d p(x, in.number());
        if (out.empty())
            out.push_back({p, {}});
        else
            out[0].curves.push_back({p, p, p, true});
    }
    return out;
}

std::vector<double> read_svg_numbers(std::string_view text, size_t n, const TextPlace& place) {
    Reader in(text, place);
    std::vector<double> out;
    while (out.size() < n) out.push_back(in.number());
    if (!in.done()) in.refuse(fmt::format("should have ended after {} numbers", n));
    return out;
}

Imath::M33d read_svg_transform(std::string_view text, const TextPlace& place) {
    Reader in(text, place);
    Imath::M33d all;
    const auto matrix = [](double a, double b, double c, double d, double e, double f) {
        return Imath::M33d(a, b, 0, c, d, 0, e, f, 1);
    };
    while (in.skip_comma(), !in.done()) {
        const std::string name(in.word());
        in.expect('(');
        std::vector<double> v;
        while (!in.done() && in.peek() != ')' && v.size() < 7) v.push_back(in.number());
        const auto has = [&](const char* kind, std::initializer_list<size_t> counts) {
            return name == kind &&
                   std::find(counts.begin(), counts.end(), v.size()) != counts.end();
        };
        const double angle = v.empty() ? 0 : v[0] * std::numbers::pi / 180;
        const double c = std::cos(angle), s = std::sin(angle), t = std::tan(angle);
        Imath::M33d one;
        if (has("matrix", {6}))
            one = matrix(v[0], v[1], v[2], v[3], v[4], v[5]);
        else if (has("translate", {1, 2}))
            one = matrix(1, 0, 0, 1, v[0], v.size() > 1 ? v[1] : 0);
        else if (has("scale", {1, 2}))
            one = matrix(v[0], 0, 0, v.back(), 0, 0);
        else if (has("rotate", {1}))
            one = matrix(c, s, -s, c, 0, 0);
        else if (has("rotate", {3}))
            one = matrix(c, s, -s, c, v[1] - c * v[1] + s * v[2], v[2] - s * v[1] - c * v[2]);
        else if (has("skewX", {1}))
            one = matrix(1, 0, t, 1, 0, 0);
        else if (has("skewY", {1}))
            one = matrix(1, t, 0, 1, 0, 0);
        else
            in.refuse(
                fmt::format("\"{}\" with {} numbers is no transform; there are matrix(6), "
                            "translate(1 or 2), scale(1 or 2), rotate(1 or 3), skewX(1) and "
                            "skewY(1)",
                            name, v.size()));
        in.expect(')');
        all = one * all;  // the last one written is done first
    }
    return all;
}

void add_ellipse_arc(svg::Subpath& to, V2d centre, V2d radii, double turn_rad, double from_rad,
                     double by_rad) {
    const double c = std::cos(turn_rad), s = std::sin(turn_rad);
    const auto placed = [&](const V2d& unit) {
        const V2d p = unit * radii;
        return centre + V2d(c * p.x - s * p.y, s * p.x + c * p.y);
    };
    const int pieces =
        std::max(1, static_cast<int>(std::ceil(std::fabs(by_rad) / (std::numbers::pi / 4))));
    const double step = by_rad / pieces, handle = 4.0 / 3 * std::tan(step / 4);
    for (int i = 0; i < pieces; ++i) {
        const double a = from_rad + i * step, b = a + step;
        const V2d first(std::cos(a), std::sin(a)), last(std::cos(b), std::sin(b));
        to.curves.push_back({placed(first + V2d(-first.y, first.x) * handle),
                             placed(last - V2d(-last.y, last.x) * handle), placed(last)});
    }
}

std::vector<std::vector<V2d>> flatten(const svg::Outline& outline) {
    V2d low(HUGE_VAL), high(-HUGE_VAL);
    const auto extend = [&](const V2d& p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    };
    for (const svg::Subpath& subpath : outline) {
        extend(subpath.start);
        for (const svg::Cubic& curve : subpath.curves)
            extend(curve.a), extend(curve.b), extend(curve.end);
    }
    const double extent = std::max(high.x - low.x, high.y - low.y) / 2;
    std::vector<std::vector<V2d>> contours;
    size_t vertices = 0;
    for (const svg::Subpath& subpath : outline) {
        if (vertices > camera::kMaxPolygonVertices) break;
        std::vector<V2d> contour{subpath.start};
        const auto add = [&](const V2d& p) {
            if ((p - contour.back()).length() > 1e-9 * extent) contour.push_back(p);
        };
        V2d p = subpath.start;
        for (const svg::Cubic& q : subpath.curves) {
            if (contour.size() > camera::kMaxPolygonVertices) break;
            // Wang 1984: sqrt(d (d - 1) / 8 * largest second difference / tolerance), d = 3.
            const double bend =
                std::max((p - q.a * 2.0 + q.b).length(), (q.a - q.b * 2.0 + q.end).length());
            const int n =
                q.straight || !(bend > 0)
                    ? 1
                    : static_cast<int>(std::ceil(std::sqrt(0.75 * bend / (1e-4 * extent))));
            for (int i = 1; i < n; ++i) {
                const double t = static_cast<double>(i) / n, s = 1 - t;
                add(p * (s * s * s) + q.a * (3 * s * s * t) + q.b * (3 * s * t * t) +
                    q.end * (t * t * t));
            }
            add(q.end);
            p = q.end;
        }
        if (contour.size() > 1 && (contour.front() - contour.back()).length() <= 1e-9 * extent)
            contour.pop_back();
        vertices += contour.size();
        contours.push_back(std::move(contour));
    }
    return contours;
}

}  // namespace petzval::io
