// SPDX-License-Identifier: Apache-2.0
// Zemax's sequential lenses. There is no public description; the meaning of the keys is that of
// files which makers of lenses give out. A key that would change the light and that Petzval cannot
// follow is an error; one that it does not know is a warning.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "camera/lens/lens.h"
#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/json_parse.h"
#include "io/file/text_lines.h"
#include "io/glass/catalogue.h"
#include "io/lens/lens_formats.h"

namespace petzval::io {
namespace {

using Words = std::vector<std::string>;

template <size_t N>
bool any_of(const std::array<const char*, N>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// Keys that are refused: shapes of the aperture and bodies in it.
constexpr std::array kRefused{"SQAP", "SQOB", "ELAP", "ELOB", "OBSC", "SPID", "UDAD", "USAP"};
// Keys that are ignored: notes, coatings, mechanics, drawing and solves, whose results stand in the
// file.
constexpr std::array kHarmless{"COMM", "COAT", "HIDE", "MIRR", "SLAB", "POPS", "PZUP",
                               "PKUP", "MAZH", "MEMA", "OEMA", "FIMP", "PPAR", "VPAR",
                               "LANG", "SCOL", "BLNK", "VDSZ", "FLAP"};

struct Surface {
    TextLine at;
    camera::LensSurface lens;  ///< in the file's unit
    std::string type = "STANDARD";
    std::vector<std::pair<TextLine, Words>> parameters;
    Words glass;
    TextLine glass_at;
    double clear_semi_diameter = 0;  ///< CLAP, 0: none
    bool infinite = false;
};

class Reader {
  public:
    Reader(const std::string& file, const std::string& name, LensGlasses& glasses)
        : file_(file), glasses_(glasses) {
        out_.lens.name = name;
    }

    LensFile read(std::string_view text) {
        for (const TextLine& line : text_lines(text, file_)) {
            const Words word = words(line.text);
            if (word.empty()) continue;
            if (word[0] == "SURF") {
                surfaces_.emplace_back().at = line;
            } else if (surfaces_.empty() || !(line.text[0] == ' ' || line.text[0] == '\t')) {
                read_system(line, word);
            } else {
                read_surface(surfaces_.back(), line, word);
            }
        }
        if (surfaces_.size() < 3)
            throw InputError(file_, "", "has no lens: it needs an object, surfaces and an image");
        if (surfaces_.size() > kMaxSurfaces)
            throw InputError(file_, "", "has more than {} surfaces", kMaxSurfaces);
        build();
        return std::move(out_);
    }

  private:
    [[noreturn]] void fail(const TextLine& line, const std::string& message) const {
        throw InputError(file_, line.place(), message);
    }
    void warn(const TextLine& line, const std::string& message) {
        out_.warnings.push_back(fmt::format("{}: {}: {}", file_, line.place(), message));
    }
    double number(const TextLine& line, const Words& word, size_t i) const {
        const auto value = i < word.size() ? finite_number(word[i]) : std::nullopt;
        if (!value) fail(line, fmt::format("has no finite number after {}", printable(word[0])));
        return *value;
    }
    // A figure that is only stated: the light does not follow from it.
    std::optional<double> stated(const TextLine& line, const Words& word, size_t i) {
        const auto value = i < word.size() ? finite_number(word[i]) : std::nullopt;
        if (!value)
            warn(line, fmt::format("{} has no finite number and is left out", printable(word[0])));
        return value;
    }
    double number_or_0(const Words& word, size_t i) const {
        return i < word.size() ? finite_number(word[i]).value_or(0) : 0;
    }

    void read_system(const TextLine& line, const Words& word);
    void read_unit(const TextLine& line, const Words& word);
    void read_surface(Surface&, const TextLine& line, const Words& word);
    void add_asphere(Surface&);
    void add_glass(Surface&);
    Glass find_glass(const Surface&);
    Glass model(const Surface&, double nd, double abbe);
    void build();
    void add(const Surface&);

    const std::string& file_;
    LensGlasses& glasses_;
    LensFile out_;
    double unit_mm_ = 1;
    bool fields_are_angles_ = false;
    double field_deg_ = 0;
    std::vector<std::string> makers_;
    std::vector<Surface> surfaces_;
};

void Reader::read_unit(const TextLine& line, const Words& word) {
    struct Unit {
        const char* name;
        double mm;
    };
    for (const auto& [name, mm] : {Unit{"MM", 1}, Unit{"CM", 10}, Unit{"IN", 25.4},
                                   Unit{"INCH", 25.4}, Unit{"M", 1000}, Unit{"METER", 1000}})
        if (word.size() > 1 && word[1] == name) {
            unit_mm_ = mm;
            return;
        }
    fail(line, "has a UNIT other than MM, CM, IN and METER");
}

void Reader::read_system(const TextLine& line, const Words& word) {
    const std::string& key = word[0];
    if (key == "UNIT") {
        read_unit(line, word);
    } else if (key == "MODE") {
        if (word.size() < 2 || word[1] != "SEQ")
            fail(line, "is not sequential; save the lens in sequential mode (MODE SEQ)");
    } else if (key == "MNUM") {
        if (number(line, word, 1) > 1)
            fail(line, "has several configurations; save the one to use as a lens of its own");
    } else if (key == "NAME") {
        out_.lens.title =
            printable(fmt::format("{}", fmt::join(word.begin() + 1, word.end(), " ")));
    } else if (key == "GCAT") {
        for (size_t i = 1; i < word.size(); ++i) makers_.push_back(lower(word[i]));
    } else if (key == "FNUM") {
        if (const auto fnumber = stated(line, word, 1); fnumber && *fnumber > 0)
            out_.lens.stated_fnumber = fnumber;
    } else if (key == "FTYP") {
        fields_are_angles_ = stated(line, word, 1) == 0.;
    } else if (key == "XFLN" || key == "YFLN") {
        for (size_t i = 1; i < word.size(); ++i)
            field_deg_ = std::max(field_deg_, std::abs(stated(line, word, i).value_or(0)));
    }
}

void Reader::read_surface(Surface& surface, const TextLine& line, const Words& word) {
    const std::string& key = word[0];
    if (key == "TYPE") {
        surface.type = word.size() > 1 ? word[1] : "";
        if (surface.type != "STANDARD" && surface.type != "EVENASPH" && surface.type != "ODDASPHE")
            fail(line, fmt::format("has a surface of type {}; Petzval takes STANDARD, EVENASPH and "
                                   "ODDASPHE, neither tilted nor decentred",
                                   printable(surface.type)));
    } else if (key == "STOP") {
        surface.lens.stop = true;
    } else if (key == "CURV") {
        surface.lens.curvature_1_mm = number(line, word, 1);
    } else if (key == "CONI") {
        surface.lens.conic = number(line, word, 1);
    } else if (key == "DISZ") {
        surface.infinite = word.size() > 1 && word[1] == "INFINITY";
        if (!surface.infinite) surface.lens.thickness_mm = number(line, word, 1);
    } else if (key == "DIAM") {
        surface.lens.semi_diameter_mm = number(line, word, 1);
    } else if (key == "CLAP") {
        if (number(line, word, 1) != 0)
            fail(line, "has an aperture with a hole (CLAP), which Petzval does not have");
        surface.clear_semi_diameter = number(line, word, 2);
    } else if (key == "OBDC") {
        if (number(line, word, 1) != 0 || number(line, word, 2) != 0)
            fail(line, "has an aperture beside the axis (OBDC), which Petzval does not have");
    } else if (key == "PARM") {
        surface.parameters.emplace_back(line, word);
    } else if (key == "GLAS") {
        surface.glass = word;
        surface.glass_at = line;
    } else if (any_of(kRefused, key)) {
        fail(line, fmt::format("has {}, which Petzval cannot follow; only round surfaces and "
                               "apertures about the axis",
                               key));
    } else if (!any_of(kHarmless, key)) {
        warn(line, fmt::format("{} is not known and left out", printable(key)));
    }
}

void Reader::add_asphere(Surface& surface) {
    if (surface.type == "STANDARD") return;
    const int step = surface.type == "EVENASPH" ? 2 : 1;
    for (const auto& [line, word] : surface.parameters) {
        const double i = number(line, word, 1), coefficient = number(line, word, 2);
        if (coefficient == 0) continue;
        const double power = i * step;
        if (!(i >= 1 && i == std::floor(i) && power >= 2 && power <= 16))
            fail(line, "has a power of r that is not from 2 to 16");
        surface.lens.asphere.push_back({power, coefficient * std::pow(unit_mm_, 1 - power)});
        if (!(std::abs(surface.lens.asphere.back()[1]) < 1e38)) fail(line, "is too large in mm");
    }
}

Glass Reader::model(const Surface& surface, double nd, double abbe) {
    const TextLine& line = surface.glass_at;
    if (!(nd >= 1 && nd <= 5 && (abbe == 0 || (abbe >= 1 && abbe <= 1e4))))
        fail(line,
             fmt::format("has a glass with nd {} and Vd {}; nd must be from 1 to 5, Vd from 1 "
                         "to 10000 or 0 for none",
                         nd, abbe));
    if (abbe == 0) return constant_glass(nd);
    Glass glass = model_glass(nd, abbe);
    if (!has_index_of_glass(glass)) fail(line, "has a glass whose Vd is too small for its nd");
    return glass;
}

Glass Reader::find_glass(const Surface& surface) {
    const TextLine& line = surface.glass_at;
    const std::string name = surface.glass.size() > 1 ? surface.glass[1] : "";
    const double nd = number_or_0(surface.glass, 4), abbe = number_or_0(surface.glass, 5);
    if (name == "MIRROR") fail(line, "has a mirror; Petzval's lenses refract only");
    if (number_or_0(surface.glass, 2) == 2)
        fail(line, "takes its glass from another surface; replace the pick-up by the glass");
    if (name == "___BLANK" || number_or_0(surface.glass, 2) == 1) {
        if (number_or_0(surface.glass, 6) != 0)
            warn(line, "the partial dispersion of its model glass is left out");
        return model(surface, nd, abbe);
    }
    for (const std::string& maker : makers_) {
        // Hikari is what Nikon's glass works are called now.
        const std::string now = maker == "nikon" || maker == "nikon-hikari" ? "hikari" : maker;
        for (const std::string& each : {maker, now})
            if (auto glass = glasses_.find(fmt::format("{}:{}", each, name)))
                return *std::move(glass);
    }
    const std::vector<Glass> others = glasses_.of_any_maker(name);
    if (others.size() == 1) {
        warn(line, fmt::format("takes {}: the file's catalogues (GCAT) have no such glass",
                               others[0].name));
        return others[0];
    }
    // 1.5 and 40 stand where Zemax's user gave no figures.
    if (nd > 1 && !(nd == 1.5 && abbe == 40)) {
        warn(line, fmt::format("takes nd {} and Vd {}: there is no one glass {}", nd, abbe,
                               printable(name)));
        return model(surface, nd, abbe);
    }
    fail(line,
         fmt::format("has the glass {}, which no catalogue has; give its catalogue (.agf), or "
                     "take one of {}",
                     printable(name), fmt::join(glasses_near(name), ", ")));
}

void Reader::add(const Surface& from) {
    auto& surfaces = out_.lens.surfaces;
    Surface at = from;
    if (at.infinite) fail(at.at, "is at an infinite distance from the next surface");
    add_asphere(at);
    camera::LensSurface& surface = at.lens;
    surface.curvature_1_mm /= unit_mm_;
    surface.thickness_mm *= unit_mm_;
    if (!at.glass.empty()) surface.glass = find_glass(at);
    const auto before = surfaces.empty() ? std::nullopt : surfaces.back().glass;
    const bool nothing = surface.glass == before && !surface.stop && at.clear_semi_diameter == 0;
    if (!(std::abs(surface.thickness_mm) <= kMaxThickness_mm))
        fail(at.at, fmt::format("has a distance of more than {} mm", kMaxThickness_mm));
    if (nothing) {
        // A surface that changes coordinates only. Before the lens it is part of the object's
        // distance.
        if (!surfaces.empty()) surfaces.back().thickness_mm += surface.thickness_mm;
        return;
    }
    if (at.clear_semi_diameter != 0) surface.semi_diameter_mm = at.clear_semi_diameter;
    surface.semi_diameter_mm *= unit_mm_;
    if (const auto fault = fault_of(surface)) fail(at.at, *fault);
    if (!surface.stop)
        surfaces.push_back(std::move(surface));
    else if (add_stop(surfaces, std::move(surface)))
        warn(at.at, kShapedStop);
}

void Reader::build() {
    const Surface &object = surfaces_.front(), &image = surfaces_.back();
    if (!object.glass.empty()) fail(object.glass_at, "has an object in glass; it must be in air");
    if (image.lens.curvature_1_mm != 0) fail(image.at, "has a curved image; films are plane");
    const Surface* stop = nullptr;
    for (const Surface& surface : surfaces_) {
        if (!surface.lens.stop) continue;
        if (stop)
            fail(surface.at,
                 fmt::format("is a second stop; that at {} is one already", stop->at.place()));
        stop = &surface;
    }
    if (!stop || stop == &object || stop == &image)
        throw InputError(file_, "", "has no stop (STOP) between its object and its image");
    for (size_t i = 1; i + 1 < surfaces_.size(); ++i) add(surfaces_[i]);
    auto& lens = out_.lens;
    lens.image_circle_mm = std::max(0., 2 * unit_mm_ * image.lens.semi_diameter_mm);
    if (!(lens.image_circle_mm <= 2 * kMaxSemiDiameter_mm)) lens.image_circle_mm = 0;
    if (fields_are_angles_ && field_deg_ > 0 && field_deg_ < 180)
        lens.stated_field_half_deg = field_deg_;
}

}  // namespace

LensFile read_lens_zmx(std::string_view text, const std::string& file, const std::string& name,
                       LensGlasses& glasses) {
    return Reader(file, name, glasses).read(text);
}

}  // namespace petzval::io
