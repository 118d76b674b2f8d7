// SPDX-License-Identifier: Apache-2.0
#include "io/spectra/spectra.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <string_view>
#include <system_error>

#include "core/spectrum/colorimetry.h"
#include "core/spectrum/colour.h"
#include "io/base/ascii.h"
#include "io/base/error.h"
#include "io/base/nearest.h"
#include "io/file/assets.h"
#include "io/file/csv.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;
using Names = std::span<const std::string_view>;

constexpr std::array<std::string_view, 3> kIlluminants{"d65", "a", "f11"};
constexpr std::array<std::string_view, 1> kResponses{"cie1931"};
constexpr std::array<std::string_view, 4> kMetals{"ag", "al", "au", "cu"};

bool ships(Names names, const std::string& name) {
    return std::find(names.begin(), names.end(), lower(name)) != names.end();
}

fs::path shipped(const std::string& name) {
    return asset("spectra/" + lower(name) + ".csv");
}

// File of a name: one that ships wins over a file of that name; ./d65 is the file.
fs::path shipped_or_file(Names names, const std::string& name_or_file) {
    if (ships(names, name_or_file)) return shipped(name_or_file);
    std::error_code none;
    if (!fs::exists(name_or_file, none))
        throw ArgumentError(
            name_or_file, "",
            fmt::format("is neither a file nor a name; the names are {}{}", fmt::join(names, ", "),
                        did_you_mean(name_or_file, {names.begin(), names.end()})));
    return name_or_file;
}

// Share of a column's greatest value below which a negative one is an instrument's noise.
constexpr double kNoise = 0.002;

// Sorts the rows by wavelength: instruments write them from red to blue too.
void sort_rows(CsvTable& table) {
    std::vector<size_t> order(table.rows.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return table.rows[a][0] < table.rows[b][0]; });
    CsvTable sorted{table.file, table.names, {}, {}};
    for (const size_t row : order) {
        sorted.rows.push_back(std::move(table.rows[row]));
        sorted.line_of_row.push_back(table.line_of_row[row]);
    }
    table = std::move(sorted);
}

// Sets values below 0 by noise to 0, and refuses others.
void mend_negative(CsvTable& table) {
    for (size_t i = 1; i < table.names.size(); ++i) {
        double greatest = 0;
        for (const auto& row : table.rows) greatest = std::max(greatest, row[i]);
        for (size_t row = 0; row < table.rows.size(); ++row) {
            double& value = table.rows[row][i];
            if (value < -kNoise * greatest)
                throw InputError(
                    table.file, table.place(row),
                    fmt::format("{} in column {} must not be below 0", value, table.names[i]));
            value = std::max(value, 0.);
        }
    }
}

// Reads a table of spectra. columns: those after the wavelength. bytes: as in read_csv.
CsvTable read_spectra(const fs::path& path, size_t columns,
                      const std::vector<uint8_t>* bytes = nullptr) {
    CsvTable table = read_csv(path, bytes);
    if (table.names.size() != 1 + columns)
        throw InputError(
            table.file, "",
            fmt::format("number of columns is {} and must be {}: wavelength in nm, then {}",
                        table.names.size(), 1 + columns,
                        columns == 1 ? "one value" : "one value for each curve"));
    sort_rows(table);
    double previous_nm = 0;
    for (size_t row = 0; row < table.rows.size(); ++row) {
        const double nm = table.rows[row][0];
        if (nm <= previous_nm)
            throw InputError(
                table.file, table.place(row),
                fmt::format("wavelength {} nm must be above {} nm; write each once, in nm", nm,
                            previous_nm));
        previous_nm = nm;
    }
    mend_negative(table);
    if (table.rows.front()[0] > kLast_nm || previous_nm < kFirst_nm)
        throw InputError(table.file, table.place(0),
                         "wavelengths {} to {} do not reach {} to {} nm; write them in nm",
                         table.rows.front()[0], previous_nm, kFirst_nm, kLast_nm);
    return table;
}

SpectrumTable tabulate(const CsvTable& table, size_t column, Extrapolate beyond, double unit = 1) {
    std::vector<std::pair<float, float>> points;
    points.reserve(table.rows.size());
    for (const auto& row : table.rows)
        points.emplace_back(static_cast<float>(row[0]), static_cast<float>(row[column] / unit));
    return petzval::tabulate(points, beyond);
}

template <size_t N>
std::array<SpectrumTable, N> tabulate(const CsvTable& table, Extrapolate beyond, double unit = 1) {
    std::array<SpectrumTable, N> curves;
    for (size_t i = 0; i < N; ++i) curves[i] = tabulate(table, 1 + i, beyond, unit);
    return curves;
}

// Area under a column's straight lines between kFirst_nm and kLast_nm, in multiples of a unit.
double area(const CsvTable& table, size_t column, double unit) {
    double sum = 0;
    for (size_t row = 0; row + 1 < table.rows.size(); ++row) {
        const double x0 = table.rows[row][0], x1 = table.rows[row + 1][0];
        const double y0 = table.rows[row][column] / unit, y1 = table.rows[row + 1][column] / unit;
        const double a = std::max(x0, double{kFirst_nm}), b = std::min(x1, double{kLast_nm});
        if (a >= b) continue;
        const auto at = [&](double x) { return y0 + (y1 - y0) * ((x - x0) / (x1 - x0)); };
        sum += (at(a) + at(b)) / 2 * (b - a);
    }
    return sum;
}

// Reads curves of any unit, scaled to a greatest value of 1 before they must fit in floats.
template <size_t N>
std::array<SpectrumTable, N> read_relative(const fs::path& path) {
    const CsvTable table = read_spectra(path, N);
    double greatest = 0;
    for (const auto& row : table.rows)
        greatest = std::max(greatest, *std::max_element(row.begin() + 1, row.end()));
    const auto curves = tabulate<N>(table, Extrapolate::Zero, greatest > 0 ? greatest : 1);
    for (size_t i = 0; i < N; ++i)
        if (!(integral(curves[i]) > 0))
            throw InputError(table.file, table.place(0),
                             fmt::format("column {} is 0 at every whole nm from {} to {}",
                                         table.names[1 + i], kFirst_nm, kLast_nm));
    for (size_t i = 0; i < N; ++i) {
        const double whole = area(table, 1 + i, greatest), kept = integral(curves[i]);
        if (kept < 0.99 * whole)
            throw InputError(table.file, "",
                             fmt::format("column {} has lines too narrow for tables of 1 nm, which "
                                         "would keep {:.0f} % of it; make them 2 nm wide",
                                         table.names[1 + i], 100 * kept / whole));
    }
    return curves;
}

V3d white_xyz(const std::array<SpectrumTable, 3>& observer) {
    return respond(observer, tabulate<1>(read_spectra(shipped("d65"), 1), Extrapolate::Zero)[0]);
}

Rgb to_srgb(const V3d& xyz, const V3d& white) {
    const V3d rgb = srgb_to_xyz(white).inverse() * xyz;
    return {static_cast<float>(rgb.x), static_cast<float>(rgb.y), static_cast<float>(rgb.z)};
}

// Linear sRGB of a reflectance under D65.
Rgb colour_of(const SpectrumTable& share) {
    const auto observer = standard_observer();
    SpectrumTable seen = tabulate<1>(read_spectra(shipped("d65"), 1), Extrapolate::Zero)[0];
    const V3d white = respond(observer, seen);
    for (size_t i = 0; i < seen.value.size(); ++i) seen.value[i] *= share.value[i];
    return to_srgb(respond(observer, seen), white);
}

CsvTable read_patches() {
    return read_spectra(shipped("colorchecker"), 24);
}

MeasuredReflectance reflectance_of(const CsvTable& table, size_t column, const std::string& name) {
    for (size_t row = 0; row < table.rows.size(); ++row)
        if (table.rows[row][column] > 1)
            throw InputError(table.file, table.place(row),
                             "{} in column {} must not be above 1; write shares, not percent",
                             table.rows[row][column], table.names[column]);
    const SpectrumTable share = tabulate(table, column, Extrapolate::Hold);
    return {name, share, Rgb(max(f4{}, min(splat(1.f), colour_of(share).v)))};
}

}  // namespace

std::array<SpectrumTable, 3> standard_observer() {
    return tabulate<3>(read_spectra(shipped("cie1931"), 3), Extrapolate::Zero);
}

std::array<SpectrumTable, 3> rgb_basis() {
    return tabulate<3>(read_spectra(shipped("rgb_basis"), 3), Extrapolate::Hold);
}

std::vector<SpectrumTable> training_reflectances() {
    const auto patches = tabulate<24>(read_patches(), Extrapolate::Hold);
    return {patches.begin(), patches.end()};
}

SpectrumTable find_illuminant(const std::string& name_or_file) {
    return read_relative<1>(shipped_or_file(kIlluminants, name_or_file))[0];
}

std::array<SpectrumTable, 3> find_response(const std::string& name_or_file) {
    return read_relative<3>(shipped_or_file(kResponses, name_or_file));
}

std::optional<Illuminant> find_light_spectrum(const std::string& name) {
    if (!ships(kIlluminants, name)) return std::nullopt;
    const auto observer = standard_observer();
    Illuminant light{lower(name), find_illuminant(name), {}};
    const double nits =
        double{kLuminousEfficacy_lm_per_w} * integral_of_product(observer[1], light.per_nit);
    for (float& value : light.per_nit.value) value = static_cast<float>(value / nits);
    const V3d white = white_xyz(observer), xyz = respond(observer, light.per_nit);
    light.rgb = to_srgb(xyz / xyz.y, white / white.y);
    return light;
}

std::optional<Metal> find_metal(const std::string& name) {
    if (!ships(kMetals, name)) return std::nullopt;
    const auto [n, k] = tabulate<2>(read_spectra(shipped(name), 2), Extrapolate::Hold);
    return Metal{lower(name), n, k};
}

Rgb colour_of(const Metal& metal) {
    SpectrumTable share;
    // Normal incidence: Born and Wolf 1999, "Principles of Optics", equation 14.2 (17).
    for (size_t i = 0; i < share.value.size(); ++i) {
        const float n = metal.n.value[i], k2 = metal.k.value[i] * metal.k.value[i];
        share.value[i] = ((n - 1) * (n - 1) + k2) / ((n + 1) * (n + 1) + k2);
    }
    return colour_of(share);
}

std::optional<MeasuredReflectance> find_reflectance(const std::string& name) {
    const CsvTable table = read_patches();
    const auto at = std::find(table.names.begin() + 1, table.names.end(), lower(name));
    if (at == table.names.end()) return std::nullopt;
    return reflectance_of(table, static_cast<size_t>(at - table.names.begin()), *at);
}

MeasuredReflectance read_reflectance(const fs::path& path, const std::vector<uint8_t>& bytes,
                                     const std::string& name) {
    return reflectance_of(read_spectra(path, 1, &bytes), 1, name);
}

std::string illuminant_names() {
    return fmt::format("{}", fmt::join(kIlluminants, ", "));
}

std::string metal_names() {
    return fmt::format("{}", fmt::join(kMetals, ", "));
}

std::vector<std::string> reflectance_names() {
    std::vector<std::string> names = read_patches().names;
    names.erase(names.begin());  // the wavelength
    return names;
}

}  // namespace petzval::io
