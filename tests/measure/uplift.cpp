// SPDX-License-Identifier: Apache-2.0
// Compares two ways from linear sRGB to reflectances: the linear basis that the renderer has
// (core/spectrum/bands.h), and sigmoids of polynomials (tests/measure/sigmoid.h). Prints tables.
//
//   uplift
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "core/scene/texture.h"
#include "core/spectrum/colour.h"
#include "io/spectra/spectra.h"
#include "tests/measure/sigmoid.h"
#include "tests/support/set_up_observer.h"
#include "tests/support/statistics.h"

namespace petzval::bench {
namespace {

using test::Random;
using Curves = std::array<SpectrumTable, 3>;

constexpr int kGrid = 33;     // points a side, evenly over encoded sRGB
constexpr int kPairs = 4000;  // of texels to filter
constexpr int kTableSmall = 32, kTableLarge = 64;

// What an eye sees of reflectances under one light.
class Eye {
  public:
    explicit Eye(const SpectrumTable& light) {
        const Curves bar = io::standard_observer();
        const double scale = 1 / integral_of_product(bar[1], light);
        for (size_t k = 0; k < 3; ++k) {
            for (size_t i = 0; i < kSpectrumSize; ++i)
                curves_[k].value[i] =
                    static_cast<float>(double(bar[k].value[i]) * light.value[i] * scale);
            white_[int(k)] = integral(curves_[k]);
        }
        to_rgb_ = srgb_to_xyz(white_).inverse();
    }
    [[nodiscard]] V3d lab(const SpectrumTable& s) const {
        return xyz_to_lab(respond(curves_, s), white_);
    }
    /// Only of use under the white of sRGB.
    [[nodiscard]] V3d lab(Rgb c) const {
        return xyz_to_lab(to_rgb_.inverse() * V3d(c[0], c[1], c[2]), white_);
    }
    [[nodiscard]] V3d xyz(const SpectrumTable& s) const { return respond(curves_, s); }
    [[nodiscard]] V3d rgb(const SpectrumTable& s) const { return to_rgb_ * respond(curves_, s); }
    [[nodiscard]] double difference(const SpectrumTable& a, const SpectrumTable& b) const {
        return delta_e_2000(lab(a), lab(b));
    }

  private:
    Curves curves_;
    V3d white_;
    Matrix3 to_rgb_;
};

struct Model {
    std::string name;
    std::function<SpectrumTable(Rgb)> uplift;
};

class Statistics {
  public:
    void add(double a) { all_.push_back(a); }
    [[nodiscard]] double mean() const {
        return std::accumulate(all_.begin(), all_.end(), 0.) / double(all_.size());
    }
    [[nodiscard]] double quantile(double share) {
        std::sort(all_.begin(), all_.end());
        return all_[static_cast<size_t>(share * double(all_.size() - 1))];
    }
    [[nodiscard]] double max() { return quantile(1); }
    [[nodiscard]] double min() { return quantile(0); }

  private:
    std::vector<double> all_;
};

double rms(const SpectrumTable& a, const SpectrumTable& b, int first_nm, int last_nm) {
    double sum = 0;
    for (int nm = first_nm; nm <= last_nm; ++nm) {
        const double off = double(a.at_nm(nm)) - b.at_nm(nm);
        sum += off * off;
    }
    return std::sqrt(sum / (last_nm - first_nm + 1));
}

SpectrumTable mean(const SpectrumTable& a, const SpectrumTable& b) {
    SpectrumTable m;
    for (size_t i = 0; i < m.value.size(); ++i) m.value[i] = 0.5f * (a.value[i] + b.value[i]);
    return m;
}

// Bands that together carry every nanometre; the last lane is off.
std::vector<Bands> every_nm(const Observer& observer) {
    std::vector<Bands> all;
    for (int nm = kFirst_nm; nm <= kLast_nm; nm += 4) {
        const auto first = static_cast<float>(nm);
        const m4 on{-1, -1, -1, nm + 3 <= kLast_nm ? -1 : 0};
        all.push_back(observer.at(f4{first, first + 1, first + 2, first + 3}, splat(1.f), on));
    }
    return all;
}

template <typename AtBands>
SpectrumTable spectrum(const std::vector<Bands>& bands, const AtBands& at) {
    SpectrumTable s;
    for (size_t first = 0; first < s.value.size(); first += 4) {
        const f4 four = at(bands[first / 4]);
        for (size_t i = first; i < std::min(first + 4, s.value.size()); ++i)
            s.value[i] = four[static_cast<int>(i - first)];
    }
    return s;
}

Rgb encoded(float r, float g, float b) {
    return {srgb_to_linear(r), srgb_to_linear(g), srgb_to_linear(b)};
}

template <typename Visit>
void over_the_cube(const Visit& visit) {
    const auto level = [](int i) { return float(i) / (kGrid - 1); };
    for (int r = 0; r < kGrid; ++r)
        for (int g = 0; g < kGrid; ++g)
            for (int b = 0; b < kGrid; ++b) visit(encoded(level(r), level(g), level(b)));
}

void compare_over_the_cube(const std::vector<Model>& models, const Eye& d65) {
    fmt::print(
        "Over {0} x {0} x {0} colours, evenly in encoded sRGB; D65.\n\n"
        "| | CIEDE2000 there and back: mean | 99 % | max | slope squared, 1/nm | turning, 1/nm | "
        "least | most | c and 1 - c add up to 1 within: mean | max "
        "|\n|---|---|---|---|---|---|---|---|---|---|\n",
        kGrid);
    for (const Model& model : models) {
        Statistics error, slope, turning, least, most, complement;
        over_the_cube([&](Rgb c) {
            const SpectrumTable s = model.uplift(c);
            const SpectrumTable rest = model.uplift(Rgb(1.f - c[0], 1.f - c[1], 1.f - c[2]));
            error.add(delta_e_2000(d65.lab(c), d65.lab(s)));
            double slope2 = 0, turn = 0, off = 0;
            const auto& v = s.value;
            for (size_t i = 0; i < v.size(); ++i) {
                off = std::max(off, std::fabs(double(v[i]) + rest.value[i] - 1));
                if (i > 0) slope2 += (double(v[i]) - v[i - 1]) * (double(v[i]) - v[i - 1]);
                if (i > 1) turn += std::fabs(double(v[i]) - 2. * v[i - 1] + v[i - 2]);
            }
            slope.add(slope2);
            turning.add(turn);
            complement.add(off);
            least.add(*std::min_element(v.begin(), v.end()));
            most.add(*std::max_element(v.begin(), v.end()));
        });
        fmt::print(
            "| {} | {:.2g} | {:.2g} | {:.2g} | {:.4f} | {:.4f} | {:.3g} | {:.7f} | {:.2g} | {:.2g} "
            "|\n",
            model.name, error.mean(), error.quantile(0.99), error.max(), slope.mean(),
            turning.mean(), least.min(), most.max(), complement.mean(), complement.max());
    }
}

struct Lights {
    Eye d65, a, f11;
};

// Where the patches are measured, and where the eye has nearly all of its sensitivity.
constexpr std::pair kWide_nm{380, 730}, kNarrow_nm{430, 670};

// How far reflectances are from what they should be: a row of a table.
class Differences {
  public:
    static void print_head() {
        fmt::print(
            "| | RMS {} to {} nm: mean | max | {} to {} nm: mean | max | CIEDE2000 D65: mean | max "
            "| A: mean | max | F11: mean | max |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
            kWide_nm.first, kWide_nm.second, kNarrow_nm.first, kNarrow_nm.second);
    }
    void add(const SpectrumTable& got, const SpectrumTable& wanted, const Lights& lights) {
        wide_.add(rms(got, wanted, kWide_nm.first, kWide_nm.second));
        narrow_.add(rms(got, wanted, kNarrow_nm.first, kNarrow_nm.second));
        d65_.add(lights.d65.difference(got, wanted));
        a_.add(lights.a.difference(got, wanted));
        f11_.add(lights.f11.difference(got, wanted));
    }
    void print(const std::string& name) {
        fmt::print("| {} |", name);
        for (Statistics* s : {&wide_, &narrow_, &d65_, &a_, &f11_})
            fmt::print(" {:.2g} | {:.2g} |", s->mean(), s->max());
        fmt::print("\n");
    }

  private:
    Statistics wide_, narrow_, d65_, a_, f11_;
};

struct Filtering {
    std::string name;
    /// What a texture in between two texels gives.
    std::function<SpectrumTable(Rgb, Rgb)> between;
    std::function<SpectrumTable(Rgb)> at;
};

// apart: largest difference of encoded channels.
void compare_filtering(const std::vector<Filtering>& ways, const Lights& lights, float apart) {
    fmt::print(
        "\nHalfway between two texels ({} random pairs, encoded channels up to {} apart), against "
        "the mean of the reflectances of the two.\n\n",
        kPairs, apart);
    Differences::print_head();
    for (const Filtering& way : ways) {
        Random random(7);
        Differences off;
        for (int i = 0; i < kPairs; ++i) {
            std::array<float, 3> one, other;
            for (size_t k = 0; k < 3; ++k) {
                one[k] = random.next();
                const float least = std::max(0.f, one[k] - apart);
                other[k] = lerp(least, std::min(1.f, one[k] + apart), random.next());
            }
            const Rgb a = encoded(one[0], one[1], one[2]);
            const Rgb b = encoded(other[0], other[1], other[2]);
            off.add(way.between(a, b), mean(way.at(a), way.at(b)), lights);
        }
        off.print(way.name);
    }
}

Rgb clipped(const V3d& rgb) {
    const auto channel = [&](int k) { return static_cast<float>(std::clamp(rgb[k], 0., 1.)); };
    return {channel(0), channel(1), channel(2)};
}

// What a material's RGB cannot say of each measured patch.
void tell_of_patches(const Model& model, const Lights& lights) {
    fmt::print(
        "\nReflectance by {} from the sRGB of each patch (clipped) against the measurement: RMS "
        "from {} to {} nm, X, Y and Z in percent of the patch's own under A and F11, CIEDE2000.\n\n"
        "| patch | RMS | X under A | Y | Z | X under F11 | Y | Z | CIEDE2000 A | F11 |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n",
        model.name, kWide_nm.first, kWide_nm.second);
    const auto print = [](const std::string& name, const std::vector<double>& v) {
        fmt::print("| {} | {:.3f} |", name, v[0]);
        for (size_t i = 1; i < v.size(); ++i)
            fmt::print(fmt::runtime(i < 7 ? " {:+.1f} |" : " {:.1f} |"), v[i]);
        fmt::print("\n");
    };
    std::vector<double> sums(9), worst(9);
    const std::vector<std::string> names = io::reflectance_names();
    for (const std::string& name : names) {
        const SpectrumTable patch = io::find_reflectance(name)->share;
        const SpectrumTable got = model.uplift(clipped(lights.d65.rgb(patch)));
        std::vector<double> row{rms(got, patch, kWide_nm.first, kWide_nm.second)};
        for (const Eye* eye : {&lights.a, &lights.f11})
            for (int k = 0; k < 3; ++k)
                row.push_back(100 * (eye->xyz(got)[k] / eye->xyz(patch)[k] - 1));
        for (const Eye* eye : {&lights.a, &lights.f11}) row.push_back(eye->difference(got, patch));
        print(name, row);
        for (size_t i = 0; i < row.size(); ++i) {
            sums[i] += row[i] * row[i];
            if (std::fabs(row[i]) > std::fabs(worst[i])) worst[i] = row[i];
        }
    }
    for (double& sum : sums) sum = std::sqrt(sum / double(names.size()));
    print("root mean square", sums);
    print("worst", worst);
}

void compare_with_nature(const std::vector<Model>& models, const Lights& lights) {
    fmt::print(
        "\n24 measured patches: reflectance from their sRGB (clipped) against the "
        "measurement.\n\n");
    Differences::print_head();
    for (const Model& model : models) {
        Differences off;
        for (const SpectrumTable& patch : io::training_reflectances()) {
            off.add(model.uplift(clipped(lights.d65.rgb(patch))), patch, lights);
        }
        off.print(model.name);
    }
}

constexpr size_t kCalls = 1 << 16;  // of different arguments
constexpr size_t kPass = 1 << 13;   // that are timed together: rarely interrupted

// Of this thread, so that other programs on the machine count less.
double cpu_time_ns() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e9 * double(t.tv_sec) + double(t.tv_nsec);
}

struct Timed {
    std::string name;
    std::function<void(size_t)> pass;  ///< kPass calls from an argument on
    Statistics ns{};
};

template <typename Call>
Timed timed(std::string name, Call call) {
    return {std::move(name), [call](size_t first) {
                for (size_t i = first; i < first + kPass; ++i) benchmark::DoNotOptimize(call(i));
            }};
}

constexpr int kSide = 2048;

// RGBA of any colours, of like colours, and of a sigmoid's coefficients and one number more.
std::vector<Image> textures() {
    constexpr size_t n = size_t{4} * kSide * kSide;
    std::vector<uint8_t> any(n), like(n);
    std::vector<float> coefficients(n);
    for (size_t i = 0; i < n; ++i) {
        any[i] = static_cast<uint8_t>(hash32(uint32_t(i)));
        like[i] = static_cast<uint8_t>(102 + any[i] / 10);
    }
    for (size_t i = 0; i < n; i += 4) {
        const float level = float(any[i]) / 255;
        const f4 c = in_powers_of_nm(V3d(8 * level, -6 * level, level));
        for (size_t k = 0; k < 4; ++k) coefficients[i + k] = c[static_cast<int>(k)];
    }
    return {Image{"any", kSide, kSide, std::move(any)},
            Image{"like", kSide, kSide, std::move(like)},
            Image{"coefficients", kSide, kSide, std::move(coefficients)}};
}

void compare_speed(const Observer& observer, const SigmoidTable& small, const SigmoidTable& large) {
    constexpr size_t paths = 32;
    constexpr size_t repetitions = 401;
    const std::vector<Image> images = textures();
    TextureSlot any, like, coefficients;
    any.image = 0, like.image = 1, coefficients.image = 2;
    any.encoding = like.encoding = Encoding::Srgb;
    Random random(3);
    std::vector<Bands> bands;
    std::vector<V2f> uv;
    std::vector<Rgb> far, near;
    std::vector<f4> sigmoids;
    for (size_t i = 0; i < paths; ++i) bands.push_back(observer.draw(random.next()));
    for (size_t i = 0; i < kCalls; ++i) uv.push_back(random.next2());
    for (size_t i = 0; i < kCalls; ++i) {
        const auto draw = [&](float least, float range) {
            const float r = random.next(), g = random.next(), b = random.next();
            return encoded(least + range * r, least + range * g, least + range * b);
        };
        far.push_back(draw(0, 1));
        near.push_back(draw(0.4f, 0.1f));
        sigmoids.push_back(large.look_up(far.back()));
    }
    // A path keeps its wavelengths for eight hits.
    const auto path = [&](size_t i) -> const Bands& { return bands[i / 8 % paths]; };
    const auto texel = [&](const TextureSlot& slot, size_t i) {
        return sample_texture(images, slot, uv[i]);
    };
    std::vector<Timed> all{
        timed("fetch of a texel, RGBA8 sRGB", [&](size_t i) { return texel(any, i); }),
        timed("fetch of a texel's coefficients, RGBA float",
              [&](size_t i) { return texel(coefficients, i); }),
        timed("basis", [&](size_t i) { return uplift_reflectance(far[i], path(i)); }),
        timed("sigmoid, coefficients known",
              [&](size_t i) { return sigmoid_reflectance(sigmoids[i], path(i)); }),
        timed("fetch, then basis",
              [&](size_t i) { return uplift_reflectance(Rgb(texel(any, i)), path(i)); }),
        timed("fetch of coefficients, then sigmoid",
              [&](size_t i) { return sigmoid_reflectance(texel(coefficients, i), path(i)); })};
    const auto by_table = [&](const char* what, const std::vector<Rgb>& colours,
                              const TextureSlot& slot) {
        for (const SigmoidTable* table : {&small, &large}) {
            const std::string name = fmt::format("sigmoid, table of {}, {}",
                                                 table == &small ? kTableSmall : kTableLarge, what);
            all.push_back(timed(name, [&, table](size_t i) {
                return sigmoid_reflectance(table->look_up(colours[i]), path(i));
            }));
            all.push_back(timed("fetch, then " + name, [&, table](size_t i) {
                return sigmoid_reflectance(table->look_up(Rgb(texel(slot, i))), path(i));
            }));
        }
    };
    by_table("like colours", near, like);
    by_table("any colours", far, any);
    for (size_t i = 0; i <= repetitions; ++i)
        for (Timed& t : all) {
            const double start = cpu_time_ns();
            t.pass(i * kPass % kCalls);
            const double took = cpu_time_ns() - start;
            if (i > 0) t.ns.add(took / kPass);  // the first pass warms up
        }
    fmt::print(
        "\nProcessor time of a call for four wavelengths, one thread, calls back to back; texels "
        "anywhere in 2048 x 2048: median "
        "of {} "
        "passes of {} calls, and their middle half.\n\n| | ns | middle half |\n|---|---|---|\n",
        repetitions, kPass);
    for (Timed& t : all)
        fmt::print("| {} | {:.1f} | {:.1f} to {:.1f} |\n", t.name, t.ns.quantile(0.5),
                   t.ns.quantile(0.25), t.ns.quantile(0.75));
    fmt::print(
        "\nMemory: basis {} bytes; table of {}: {} bytes; table of {}: {} bytes. A texel: 4 bytes "
        "as colour, 16 as coefficients.\n",
        sizeof(Curves), kTableSmall, small.bytes(), kTableLarge, large.bytes());
}

void run() {
    const SpectrumTable white = io::find_illuminant("d65");
    const Lights lights{Eye(white), Eye(io::find_illuminant("a")), Eye(io::find_illuminant("f11"))};
    const Observer observer = test::observer_of({});
    const std::vector<Bands> bands = every_nm(observer);

    const SigmoidFit fit(io::standard_observer(), white);
    const SigmoidTable small(kTableSmall, fit), large(kTableLarge, fit);
    const auto basis = [&](Rgb c) {
        return spectrum(bands, [&](const Bands& b) { return uplift_reflectance(c, b); });
    };
    const auto of_coefficients = [&](f4 c) {
        return spectrum(bands, [&](const Bands& b) { return sigmoid_reflectance(c, b); });
    };
    const auto fitted = [&](Rgb c) {
        return in_powers_of_nm(fit.fit(V3d(c[0], c[1], c[2]), in_unit_range(large.look_up(c))));
    };
    const auto direct = [&](Rgb c) { return of_coefficients(fitted(c)); };
    const auto by_small = [&](Rgb c) { return of_coefficients(small.look_up(c)); };
    const auto by_large = [&](Rgb c) { return of_coefficients(large.look_up(c)); };
    const std::vector<Model> models{{"basis", basis},
                                    {"sigmoid, fitted", direct},
                                    {fmt::format("sigmoid, table of {}", kTableSmall), by_small},
                                    {fmt::format("sigmoid, table of {}", kTableLarge), by_large}};

    compare_over_the_cube(models, lights.d65);
    std::vector<Filtering> ways;
    for (const Model& model : models)
        ways.push_back({model.name + ", of the mean colour",
                        [&](Rgb a, Rgb b) { return model.uplift((a + b) * 0.5f); }, model.uplift});
    ways.push_back({"sigmoid, fitted, of the mean coefficients",
                    [&](Rgb a, Rgb b) { return of_coefficients((fitted(a) + fitted(b)) * 0.5f); },
                    direct});
    for (const float apart : {1.f, 0.1f}) compare_filtering(ways, lights, apart);
    compare_with_nature(models, lights);
    tell_of_patches(models.front(), lights);
    compare_speed(observer, small, large);
}

}  // namespace
}  // namespace petzval::bench

int main() {
    petzval::bench::run();
}
