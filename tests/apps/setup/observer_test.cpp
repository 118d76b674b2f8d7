// SPDX-License-Identifier: Apache-2.0
#include "core/spectrum/observer.h"

#include <gtest/gtest.h>

#include "core/spectrum/colorimetry.h"
#include "core/spectrum/colour.h"
#include "core/spectrum/sensor_fit.h"
#include "io/spectra/spectra.h"
#include "tests/support/chi_square.h"
#include "tests/support/set_up_observer.h"
#include "tests/support/statistics.h"

namespace petzval::apps {
namespace {

using test::observer_of;

// Mean over evenly spread draws: the integral over wavelengths but for the grain of the draws.
template <class Value>
V3d mean_over_draws(const Observer& observer, const Value& value) {
    constexpr int n = 1 << 16;
    V3d sum(0.);
    for (int i = 0; i < n; ++i) {
        const Bands bands = observer.draw((static_cast<float>(i) + 0.5f) / n);
        sum += V3d(value(bands)) / n;
    }
    return sum;
}

V3f vector(Rgb c) {
    return {c[0], c[1], c[2]};
}

void expect_near(const V3d& a, const V3d& b, double tolerance, const std::string& what = "") {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << what << " channel " << i;
}

TEST(Observer, WithoutSpectraTheLanesAreRgb) {
    const Observer observer;
    EXPECT_FALSE(observer.spectral());
    const Bands bands = observer.draw(0.3f);
    const Rgb colour(0.2f, 0.5f, 3.f);
    const Rgb back = to_rgb(uplift_radiance(colour, bands), bands);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(back[i], colour[i]);
}

TEST(Observer, RgbLightReadsBackAsItself) {
    const Observer observer = observer_of({});
    for (const Rgb c : {Rgb(1.f), Rgb(1, 0, 0), Rgb(0, 1, 0), Rgb(0, 0, 1), Rgb(7, 0.1f, 2)}) {
        const V3d back = mean_over_draws(observer, [&](const Bands& bands) {
            return vector(to_rgb(uplift_radiance(c, bands), bands));
        });
        expect_near(back, V3d(vector(c)), 1e-4 * hmax(c.v));
    }
}

TEST(Observer, RgbReflectanceReadsBackAsItself) {
    const Observer observer = observer_of({});
    const Rgb c(0.8f, 0.3f, 0.05f);
    const V3d back = mean_over_draws(observer, [&](const Bands& bands) {
        return vector(reflectance_to_rgb(uplift_reflectance(c, bands), bands));
    });
    expect_near(back, V3d(vector(c)), 1e-4);
}

TEST(Observer, ReflectancesStayBetweenNothingAndAll) {
    const Observer observer = observer_of({});
    for (int i = 0; i < 4096; ++i) {
        const Bands bands = observer.draw((static_cast<float>(i) + 0.5f) / 4096);
        const f4 sum = bands.red + bands.green + bands.blue;
        for (int lane = 0; lane < 4; ++lane) {
            EXPECT_NEAR(sum[lane], 1.f, 2e-6f) << bands.nm[lane];
            for (const f4 basis : {bands.red, bands.green, bands.blue}) {
                EXPECT_GE(basis[lane], 0.f) << bands.nm[lane];
                EXPECT_LE(basis[lane], 1.f) << bands.nm[lane];
            }
        }
    }
}

TEST(Observer, D65HasTheWhitePointAndOneNit) {
    const Observer observer = observer_of({});
    const V3d xyz = mean_over_draws(observer, [&](const Bands& bands) {
        return observer.to_xyz(uplift_radiance(Rgb(1.f), bands), bands);
    });
    // CIE 015:2018, table 11.1 (D65): 95.04, 100, 108.88.
    expect_near(xyz, V3d(0.9504, 1., 1.0888), 2e-4);
}

TEST(Observer, AnotherIlluminantIsWhiteAfterWhiteBalanceOnly) {
    for (const std::string name : {"a", "f11"}) {
        const auto white = [&](WhiteBalance balance) {
            SpectralRequest request;
            request.illuminant = name;
            request.white_balance = balance;
            const Observer observer = observer_of(request);
            return mean_over_draws(observer, [&](const Bands& bands) {
                return vector(to_rgb(uplift_radiance(Rgb(1.f), bands), bands));
            });
        };
        expect_near(white(WhiteBalance::Illuminant), V3d(1.), 2e-4, name);
        const V3d warm = white(WhiteBalance::None);
        EXPECT_GT(warm.x, 1.1) << name;
        EXPECT_LT(warm.z, 0.9) << name;
        EXPECT_NEAR(warm.dot(V3d(0.2126, 0.7152, 0.0722)), 1., 1e-3) << name;
    }
}

TEST(Observer, DrawsFollowTheDensity) {
    for (const bool with_bins : {false, true}) {
        SpectralRequest request;
        if (with_bins) request.bins = Bins{380.5, 10, 35};
        const Observer observer = observer_of(request);
        constexpr int cells = 94, width_nm = 5, n = 20000;
        std::vector<double> observed(cells), expected(cells);
        test::Random random(3);
        double sum = 0;
        for (int nm = kFirst_nm; nm < kLast_nm; ++nm) {
            const float pdf = observer.pdf(static_cast<float>(nm) + 0.5f);
            sum += pdf;
            expected[static_cast<size_t>((nm - kFirst_nm) / width_nm)] += pdf * n;
        }
        EXPECT_NEAR(sum, 1, 1e-5);
        for (int i = 0; i < n; ++i) {
            // One lane of four, as the four are not independent.
            const Bands bands = observer.draw(random.next());
            const float nm = bands.nm[i % 4];
            // Rounded up, a draw may be the first wavelength of the next nanometre.
            const bool whole = nm == std::floor(nm);
            const float pdf = observer.pdf(nm), before = observer.pdf(nm - 0.5f);
            EXPECT_TRUE(bands.pdf[i % 4] == pdf || (whole && bands.pdf[i % 4] == before)) << nm;
            observed[static_cast<size_t>((nm - kFirst_nm) / width_nm)] += 1;
        }
        EXPECT_TRUE(test::chi_square(observed, expected)) << with_bins;
    }
}

TEST(Observer, BinsGetHalfOfTheWavelengths) {
    SpectralRequest request;
    request.bins = Bins{380, 10, 35};
    const Observer even = observer_of(request), sensor = observer_of({});
    for (const float nm : {381.f, 500.f, 729.f})
        EXPECT_NEAR(even.pdf(nm), 0.5f * sensor.pdf(nm) + 0.5f / 350, 1e-6f) << nm;
    EXPECT_NEAR(even.pdf(750.f), 0.5f * sensor.pdf(750.f), 1e-7f);
}

// Three narrow lines and a bin far from them: XYZ needs wavelengths where neither is.
TEST(Observer, XyzOfASensorThatIsNearlyBlind) {
    ObserverInput in;
    in.xyz_bar = io::standard_observer();
    in.white = io::find_illuminant("d65");
    in.basis = io::rgb_basis();
    for (const int i : {0, 1, 2}) in.response[size_t(i)].at_nm(600 - 75 * i) = 1;
    in.matrix = {V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1)};
    in.bins = Bins{500, 10, 1};
    const Observer observer(in);
    const V3d white = respond(in.xyz_bar, in.white);
    expect_near(
        mean_over_draws(observer, [&](const Bands& b) { return observer.to_xyz(b.white, b); }),
        white / white.y, 0.01);
}

TEST(Observer, FourQuartersOfTheSpectrumInEveryDraw) {
    const Observer observer = observer_of({});
    std::array<float, 3> quartile{};
    for (int k = 0; k < 3; ++k) {
        double below = 0;
        float nm = kFirst_nm;
        for (; below < 0.25 * (k + 1); ++nm) below += observer.pdf(nm + 0.5f);
        quartile[static_cast<size_t>(k)] = nm;
    }
    for (int i = 0; i < 100; ++i) {
        const Bands bands = observer.draw(static_cast<float>(i) / 100);
        std::array<int, 4> count{};
        for (int lane = 0; lane < 4; ++lane) {
            int k = 0;
            while (k < 3 && bands.nm[lane] > quartile[static_cast<size_t>(k)]) ++k;
            ++count[static_cast<size_t>(k)];
        }
        // An edge lies within a nanometre of the quartile.
        int full = 0;
        for (const int c : count) full += c == 1;
        EXPECT_GE(full, 2);
    }
}

TEST(Observer, OneLaneIsAnEstimateOfItsOwn) {
    const Observer observer = observer_of({});
    constexpr int n = 1 << 16;
    V3d sum(0.);
    for (int i = 0; i < n; ++i) {
        const float nm = kFirst_nm + (kLast_nm - kFirst_nm) * (static_cast<float>(i) + 0.5f) / n;
        const Bands bands =
            observer.at(splat(nm), splat(1.f / (kLast_nm - kFirst_nm)), m4{-1, 0, 0, 0});
        sum += V3d(vector(to_rgb(uplift_radiance(Rgb(2, 1, 0.5f), bands), bands))) / n;
    }
    expect_near(sum, V3d(2, 1, 0.5), 1e-3);
}

// The eye's own curves, mixed: the fit must take the mixture apart again.
TEST(SensorFit, UndoesAMixtureOfTheEyesCurves) {
    const auto xyz_bar = io::standard_observer();
    const SpectrumTable light = io::find_illuminant("a");
    std::array<SpectrumTable, 3> mixed;
    for (size_t i = 0; i < light.value.size(); ++i) {
        const float x = xyz_bar[0].value[i], y = xyz_bar[1].value[i], z = xyz_bar[2].value[i];
        mixed[0].value[i] = 3 * x + y;
        mixed[1].value[i] = y + 0.5f * z;
        mixed[2].value[i] = z + 0.1f * x;
    }
    const Matrix3 to_rgb = srgb_to_xyz(V3d(0.9505, 1, 1.0888)).inverse();
    const SensorFit fit = fit_sensor(mixed, xyz_bar, light, to_rgb, io::training_reflectances());
    EXPECT_LT(fit.worst_delta_e, 1e-3);
    const V3d xyz(0.3, 0.4, 0.2);
    const V3d seen(3 * xyz.x + xyz.y, xyz.y + 0.5 * xyz.z, xyz.z + 0.1 * xyz.x);
    expect_near(fit.matrix * seen, to_rgb * xyz, 1e-4);
}

// Curves that no matrix makes into the eye's leave a residual, but not on white.
TEST(SensorFit, WhiteIsExactWhateverTheCurves) {
    const auto xyz_bar = io::standard_observer();
    const SpectrumTable light = io::find_illuminant("d65");
    std::array<SpectrumTable, 3> bands;
    for (int nm = kFirst_nm; nm <= kLast_nm; ++nm) {
        bands[0].at_nm(nm) = nm > 580 && nm < 700 ? 0.8f : 0.f;
        bands[1].at_nm(nm) = nm > 490 && nm < 600 ? 1.f : 0.f;
        bands[2].at_nm(nm) = nm > 400 && nm < 500 ? 1.3f : 0.f;
    }
    const V3d white = respond(xyz_bar, light);
    const Matrix3 to_rgb = srgb_to_xyz(white / white.y).inverse();
    const SensorFit fit = fit_sensor(bands, xyz_bar, light, to_rgb, io::training_reflectances());
    const V3d seen = fit.matrix * respond(bands, light), meant = to_rgb * white;
    expect_near(seen / white.y, meant / white.y, 1e-9);
    EXPECT_GT(fit.worst_delta_e, fit.mean_delta_e);
    EXPECT_GT(fit.mean_delta_e, 0.5);
    EXPECT_LT(fit.mean_delta_e, 6);

    bands[2] = bands[1];
    EXPECT_THROW(
        static_cast<void>(fit_sensor(bands, xyz_bar, light, to_rgb, io::training_reflectances())),
        std::invalid_argument);
}

}  // namespace
}  // namespace petzval::apps
