// SPDX-License-Identifier: Apache-2.0
// Layout and rules: ANSI/IESNA LM-63-2002, sections 5 and 6. Axes: KHR EXT_lights_ies, "Coordinate
// System Mapping".
#include "io/ies/ies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/printable.h"
#include "io/file/text_lines.h"

namespace petzval::io {
namespace {

constexpr double kMostCandela = 1e20;

/// The numbers behind the line TILT=, in order.
class Numbers {
  public:
    Numbers(std::vector<TextLine> lines, size_t first, const std::string& file,
            const std::string& place)
        : lines_(std::move(lines)), line_(first), file_(file), place_(place) {}

    [[noreturn]] void fail(const std::string& message) const {
        const size_t at = line_ - 1;  // at least that of TILT=
        throw InputError(file_, place_, "IES profile, line {}: {}", lines_[at].number, message);
    }
    /// The next number; what: its name, for messages.
    double next(const char* what, double least, double most) {
        while (word_ == words_.size()) {
            if (line_ >= lines_.size()) fail(fmt::format("ends before {}", what));
            std::string text = lines_[line_].text;
            std::replace(text.begin(), text.end(), ',', ' ');
            words_ = words(text);
            word_ = 0;
            ++line_;
        }
        const auto value = finite_number(words_[word_]);
        if (!value)
            fail(
                fmt::format("\"{}\" is no number; here stands {}", printable(words_[word_]), what));
        if (!(*value >= least && *value <= most))
            fail(fmt::format("{} is {:g}, but must be from {:g} to {:g}", what, *value, least,
                             most));
        ++word_;
        return *value;
    }
    size_t count(const char* what, size_t least) {
        constexpr double most = 1e6;
        const double value = next(what, double(least), most);
        if (value != std::floor(value)) fail(fmt::format("{} must be a whole number", what));
        return static_cast<size_t>(value);
    }
    /// So many numbers. The list grows as they are found: the count may be a lie.
    std::vector<double> list(size_t size, const char* what, double least, double most) {
        std::vector<double> values;
        while (values.size() < size) values.push_back(next(what, least, most));
        return values;
    }
    std::vector<double> ascending(size_t size, const char* what, double least, double most) {
        std::vector<double> values;
        while (values.size() < size) {
            values.push_back(next(what, least, most));
            // As floats, which they become.
            if (values.size() > 1 && !(static_cast<float>(values.back()) >
                                       static_cast<float>(values[values.size() - 2])))
                fail(fmt::format("{}s must increase", what));
        }
        return values;
    }

  private:
    std::vector<TextLine> lines_;
    size_t line_;
    const std::string& file_;
    const std::string& place_;
    std::vector<std::string> words_;
    size_t word_ = 0;
};

/// Number of the file's column at each azimuth, degrees.
using Columns = std::map<float, size_t>;

/// Azimuths of type C in [0, 360), with the symmetry that the ends of the horizontal angles mean.
Columns columns_of_c(const std::vector<double>& horizontal, const Numbers& numbers) {
    const double first = horizontal.front(), last = horizontal.back();
    Columns columns;
    const auto add = [&](double angle, size_t column) {
        const double turned = std::fmod(std::fmod(angle, 360.) + 360., 360.);
        columns.try_emplace(static_cast<float>(turned), column);
    };
    const bool around = last - first > 180;
    const bool quadrant = first == 0 && last == 90;
    const bool about_0 = quadrant || (first == 0 && last == 180);
    const bool about_90 = quadrant || (first == 90 && last == 270);
    if (horizontal.size() > 1 && !around && !about_0 && !about_90)
        numbers.fail(
            fmt::format("horizontal angles of type C cannot run from {:g} to {:g}", first, last));
    for (size_t i = 0; i < horizontal.size(); ++i) {
        const double h = horizontal[i];
        add(h, i);
        if (about_0) add(-h, i);
        if (about_90) add(180 - h, i);
        if (quadrant) add(180 + h, i);
    }
    return columns;
}

LightProfile profile_of_c(const std::vector<double>& vertical,
                          const std::vector<double>& horizontal, const std::vector<double>& candela,
                          const Numbers& numbers) {
    const Columns columns = columns_of_c(horizontal, numbers);
    std::vector<float> azimuths, intensities;
    const auto add = [&](float azimuth, size_t column) {
        if (!azimuths.empty() && azimuth <= azimuths.back()) return;
        azimuths.push_back(azimuth);
        for (size_t i = 0; i < vertical.size(); ++i)
            intensities.push_back(static_cast<float>(candela[column * vertical.size() + i]));
    };
    const auto first = *columns.begin(), last = *columns.rbegin();
    if (first.first > 0) add(last.first - 360, last.second);
    for (const auto& [azimuth, column] : columns) add(azimuth, column);
    add(first.first + 360, first.second);
    return {ProfilePole::Forward,
            {vertical.begin(), vertical.end()},
            std::move(azimuths),
            std::move(intensities)};
}

/// Place of each angle in (-90, 90), mirrored about 0 where none is below it.
Columns mirrored(const std::vector<double>& angles) {
    Columns columns;
    for (size_t i = 0; i < angles.size(); ++i) {
        columns.try_emplace(static_cast<float>(90 + angles[i]), i);
        if (angles.front() >= 0) columns.try_emplace(static_cast<float>(90 - angles[i]), i);
    }
    return columns;
}

LightProfile profile_of_b(const std::vector<double>& vertical,
                          const std::vector<double>& horizontal, const std::vector<double>& candela,
                          const Numbers& numbers) {
    const Columns rows = mirrored(vertical), columns = mirrored(horizontal);
    if (rows.size() < 2 || columns.size() < 2)
        numbers.fail("type B needs two vertical and two horizontal angles at least");
    std::vector<float> polars, azimuths, intensities;
    for (const auto& [polar, row] : rows) polars.push_back(polar);
    for (const auto& [azimuth, column] : columns) {
        azimuths.push_back(azimuth);
        for (const auto& [polar, row] : rows)
            intensities.push_back(static_cast<float>(candela[column * vertical.size() + row]));
    }
    return {ProfilePole::Side, std::move(polars), std::move(azimuths), std::move(intensities)};
}

/// Whether the third of the numbers about the ballast is a factor on the intensities: in later
/// editions it is kept for future use, and in the latest tells how the file was made.
bool has_photometric_factor(const std::string& first_line) {
    return first_line.find("LM-63-2002") == std::string::npos &&
           first_line.find("LM-63-2019") == std::string::npos;
}

}  // namespace

IesFile parse_ies(std::string_view text, const std::string& file, const std::string& place) {
    const auto refuse = [&](const std::string& why) { return InputError(file, place, why); };
    std::vector<TextLine> lines = text_lines(text, file);
    const auto tilt = std::find_if(lines.begin(), lines.end(), [](const TextLine& line) {
        return line.text.starts_with("TILT=");
    });
    if (tilt == lines.end()) throw refuse("is no IES profile: it has no line TILT=");
    std::vector<std::string> remarks;
    const std::vector<std::string> tilt_words = words(tilt->text.substr(5));
    const std::string how = tilt_words.empty() ? "" : tilt_words[0];
    const bool factor = has_photometric_factor(lines.front().text);
    Numbers numbers(lines, static_cast<size_t>(tilt - lines.begin()) + 1, file, place);
    constexpr double any = 1e9;
    if (how == "INCLUDE") {
        (void)numbers.next("the lamp-to-luminaire geometry", -any, any);
        const size_t pairs = numbers.count("the number of tilt angles", 0);
        (void)numbers.list(pairs, "a tilt angle", -any, any);
        (void)numbers.list(pairs, "a tilt factor", -any, any);
    }
    if (how != "NONE")
        remarks.push_back("its factors for tilted lamps are not applied; it shines as upright");

    (void)numbers.next("the number of lamps", -any, any);
    (void)numbers.next("the lumens per lamp", -any, any);
    double scale = numbers.next("the candela multiplier", 0, kMostCandela);
    const size_t rows = numbers.count("the number of vertical angles", 2);
    const size_t columns = numbers.count("the number of horizontal angles", 1);
    const double type = numbers.next("the photometric type", 1, 3);
    if (type == 3) numbers.fail("photometry of type A is not read; convert it to type C");
    if (type != 1 && type != 2) numbers.fail("the photometric type must be 1 (C), 2 (B) or 3 (A)");
    for (const char* what : {"the units", "the width", "the length", "the height"})
        (void)numbers.next(what, -any, any);
    scale *= numbers.next("the ballast factor", 0, any);
    const double second = numbers.next("the number behind the ballast factor", -any, any);
    if (factor) scale *= std::max(second, 0.);
    (void)numbers.next("the input watts", -any, any);

    const bool c = type == 1;
    const auto vertical = numbers.ascending(rows, "vertical angle", c ? 0 : -90, c ? 180 : 90);
    const auto horizontal =
        numbers.ascending(columns, "horizontal angle", c ? -360 : -90, c ? 360 : 90);
    if (horizontal.back() - horizontal.front() > 360) numbers.fail("horizontal angles overlap");
    auto candela = numbers.list(rows * columns, "an intensity", 0, kMostCandela);
    for (double& value : candela) {
        value *= scale;
        if (!(value <= kMostCandela)) numbers.fail("an intensity is too great");
    }
    return {c ? profile_of_c(vertical, horizontal, candela, numbers)
              : profile_of_b(vertical, horizontal, candela, numbers),
            std::move(remarks)};
}

}  // namespace petzval::io
