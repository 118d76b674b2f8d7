// SPDX-License-Identifier: Apache-2.0
#include "apps/chart/chart_methods.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "apps/chart/traversal_leaks.h"
#include "apps/request/option_text.h"
#include "apps/request/value_error.h"
#include "apps/setup/equivalent_camera.h"
#include "camera/iris/iris.h"
#include "core/film/spectral_film.h"
#include "io/aperture/aperture_file.h"
#include "io/base/error.h"
#include "io/base/nearest.h"
#include "io/file/atomic_file.h"
#include "io/image/picture_files.h"

namespace petzval::apps {
namespace {

/// Resolved request and camera of a scene, and its number of lights.
struct ResolvedScene {
    SceneRequest request;  ///< with the settings of the file's camera
    CameraReport report;
    size_t lights = 0;
};

bool is_prescription(const CameraRequest& camera) {
    return camera.lens && *camera.lens != "pinhole" && *camera.lens != "thin" &&
           !camera.lens->starts_with("singlet:");
}

ResolvedScene resolved(const SceneRequest& request, const SetUpView& open) {
    const RenderSetup setup = open(request);
    return {resolved_request(setup), setup.from.camera, setup.prepared.scene->lights.size()};
}

/// Collects the methods of one case.
class Cases {
  public:
    Cases(ChartAxis axis, const integrator::RenderJob& job, std::string name, std::string title)
        : job_(job) {
        case_.axis = axis;
        case_.name = std::move(name);
        case_.title = std::move(title);
    }
    using Change = std::function<void(SceneRequest&, integrator::RenderJob&)>;

    void remark(const std::string& text) { case_.remarks.push_back(as_options(text)); }
    /// Request with a real lens, where wavelengths and rims ask for one: its own, else kChartLens.
    SceneRequest with_lens(const ResolvedScene& found) {
        SceneRequest request = found.request;
        CameraRequest& camera = request.camera;
        if (is_prescription(camera)) return request;
        remark(fmt::format("No lens with a prescription was asked for: {} was taken", kChartLens));
        camera.lens = kChartLens;
        camera.fit = Fit::Lens;
        camera.fov_deg = camera.focal_length_mm = camera.lens_radius_m = std::nullopt;
        camera.film_distance_mm = std::nullopt;
        return request;
    }
    ChartMethod& add(std::string name, const SceneRequest& base, const Change& change) {
        return case_.methods.emplace_back(made(std::move(name), base, change));
    }
    void reference(std::string name, const SceneRequest& base, const Change& change) {
        case_.reference = made(std::move(name), base, change);
    }
    /// By independent points.
    void independent_reference(const std::string& name, const SceneRequest& base,
                               const Change& change) {
        reference(name + ", independent points", base, change);
        case_.reference.job.sampler = SamplerKind::Independent;
    }
    [[nodiscard]] std::vector<ChartCase> result() && { return {std::move(case_)}; }

  private:
    [[nodiscard]] ChartMethod made(std::string name, const SceneRequest& base,
                                   const Change& change) const {
        ChartMethod method{std::move(name), base, job_};
        change(method.scene, method.job);
        return method;
    }

    integrator::RenderJob job_;
    ChartCase case_;
};

/// The lens of references, without the errors that a chart looks for.
void split_in_doubles(SceneRequest& scene, integrator::RenderJob&) {
    scene.camera.dispersion = camera::DispersionMode::Split;
    scene.camera.precision = camera::Precision::Double;
}

std::vector<ChartCase> camera_cases(const ResolvedScene& found, const ChartSubject& subject,
                                    const SetUpView& open) {
    Cases cases(ChartAxis::Camera, subject.job, "camera",
                "models of the camera against its lens (a bias is their point)");
    SceneRequest lens = cases.with_lens(found);
    const RenderSetup setup = open(lens);
    const CameraReport& report = setup.from.camera;
    lens.camera.focus = FocusDistance{report.focus_m};
    const SceneRequest thin = equivalent_thin_lens(lens, setup);
    cases.remark(
        fmt::format("Pinhole, thin and singlet stand in the entrance pupil of the lens, "
                    "see {:.4g} degrees as it does when it is focused, and have its iris",
                    *thin.camera.fov_deg));
    cases.add("pinhole", equivalent_pinhole(lens, setup),
              [](SceneRequest&, integrator::RenderJob&) {});
    cases.add("thin", thin, [](SceneRequest&, integrator::RenderJob&) {});
    cases.add("singlet", thin,
              [](SceneRequest& s, integrator::RenderJob&) { s.camera.lens = "singlet:N-BK7"; });
    cases.add("lens one-ray", lens, [](SceneRequest& s, integrator::RenderJob&) {
        s.camera.dispersion = camera::DispersionMode::Shared;
    });
    cases.add("lens", lens, [](SceneRequest& s, integrator::RenderJob&) {
        s.camera.dispersion = camera::DispersionMode::Hero;
    });
    cases.reference("the lens, wavelengths always split, rays followed in doubles", lens,
                    split_in_doubles);
    return std::move(cases).result();
}

std::vector<ChartCase> dispersion_cases(const ResolvedScene& found, const ChartSubject& subject,
                                        const SetUpView&) {
    Cases cases(ChartAxis::Dispersion, subject.job, "dispersion",
                "ways to carry wavelengths through the lens");
    SceneRequest lens = cases.with_lens(found);
    lens.spectral.mode = SpectralMode::Wavelengths;
    const auto with = [](camera::DispersionMode dispersion) {
        return [dispersion](SceneRequest& s, integrator::RenderJob&) {
            s.camera.dispersion = dispersion;
        };
    };
    cases.add("split", lens, with(camera::DispersionMode::Split));
    cases.add("shared", lens, with(camera::DispersionMode::Shared));
    cases.add("hero", lens, with(camera::DispersionMode::Hero));
    cases.remark("shared is biased: it leaves out the colour errors of the lens");
    cases.reference("split, rays followed in doubles with the glasses' own formulas", lens,
                    split_in_doubles);
    return std::move(cases).result();
}

std::vector<ChartCase> spectral_cases(const ResolvedScene& found, const ChartSubject& subject,
                                      const SetUpView&) {
    Cases cases(ChartAxis::Spectral, subject.job, "spectral", "what a path carries");
    const auto with = [](SpectralMode mode) {
        return [mode](SceneRequest& s, integrator::RenderJob&) { s.spectral.mode = mode; };
    };
    cases.add("rgb", found.request, with(SpectralMode::Rgb));
    cases.add("wavelengths", found.request, with(SpectralMode::Wavelengths));
    cases.add("wavelengths with bins", found.request,
              [](SceneRequest& s, integrator::RenderJob& j) {
                  s.spectral.mode = SpectralMode::Wavelengths;
                  s.spectral.bins = Bins{380, 10, 35};
                  j.replicates = kReplicates;
              });
    cases.remark("The bins are 35 of 10 nm");
    cases.remark("rgb is biased where light and reflectance multiply by wavelength");
    cases.independent_reference("wavelengths", found.request, with(SpectralMode::Wavelengths));
    return std::move(cases).result();
}

/// Writes an iris: a rectangle 1000 times as long as it is wide, aslant, so that its bounding box
/// is mostly empty.
std::string write_sliver(const std::filesystem::path& folder) {
    const auto path = folder / "iris-sliver.svg";
    io::write_file_atomically(
        path, std::string_view("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-1000 "
                               "-1000 2000 2000\">\n<rect x=\"-500\" y=\"-0.5\" "
                               "width=\"1000\" height=\"1\" transform=\"rotate(-30)\"/>\n"
                               "</svg>\n"));
    return path.string();
}

/// Writes an iris: a disk that darkens towards its rim, as an apodisation filter does.
std::string write_mask(const std::filesystem::path& folder) {
    constexpr int kSide = 64;
    io::Picture mask;
    mask.width = mask.height = mask.full_width = mask.full_height = kSide;
    mask.channels = {"R", "G", "B"};
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const double r = std::hypot(x - 31.5, y - 31.5) / 32;
            mask.pixels.insert(mask.pixels.end(), 3, float(std::fmax(0, 1 - r * r)));
        }
    const auto path = folder / "iris-mask.png";
    io::write_8bit(path, mask);
    return path.string();
}

std::vector<ChartCase> iris_cases(const ResolvedScene& found, const ChartSubject& subject,
                                  const SetUpView&) {
    const std::vector<std::pair<std::string, std::string>> shapes{
        {"disk", "circle"},
        {"hexagon", "polygon:6"},
        {"star", "star:5"},
        {"sliver", write_sliver(subject.folder)},
        {"mask", write_mask(subject.folder)}};
    std::vector<ChartCase> all;
    for (const auto& [name, aperture] : shapes) {
        Cases cases(ChartAxis::Iris, subject.job, "iris-" + name,
                    "ways to draw points of the iris: " + name);
        SceneRequest lens = cases.with_lens(found);
        lens.camera.dispersion =
            camera::DispersionMode::Shared;  // the iris is measured, not the glass
        cases.remark("One ray for all wavelengths");
        lens.camera.aperture = aperture;
        // A sliver of the round stop's area would reach far beyond the stop's rim.
        const bool sliver = name == "sliver";
        lens.camera.aperture_scale =
            sliver ? camera::ApertureScale::Inscribed : camera::ApertureScale::EqualArea;
        const auto by = [](camera::IrisSampling way) {
            return [way](SceneRequest& s, integrator::RenderJob&) { s.camera.iris_sampling = way; };
        };
        for (const camera::IrisSampling way : camera::iris_samplings(io::parse_aperture(aperture)))
            cases.add(name_of(way), lens, by(way));
        if (sliver)
            cases.remark(
                "1:1000 and aslant: rejection mostly gives up and falls back on triangles");
        const camera::IrisSampling simple =
            sliver ? camera::IrisSampling::Triangles : camera::IrisSampling::Rejection;
        cases.independent_reference(name_of(simple), lens, by(simple));
        all.push_back(std::move(cases).result().front());
        all.back().weight = 1. / static_cast<double>(shapes.size());
    }
    return all;
}

std::vector<ChartCase> sampler_cases(const ResolvedScene& found, const ChartSubject& subject,
                                     const SetUpView&) {
    Cases cases(ChartAxis::Sampler, subject.job, "sampler", "sources of sample points");
    for (const auto& [name, kind] :
         {std::pair{"independent", SamplerKind::Independent},
          std::pair{"sobol", SamplerKind::Sobol}, std::pair{"owen", SamplerKind::Owen}})
        cases.add(name, found.request,
                  [way = kind](SceneRequest&, integrator::RenderJob& j) { j.sampler = way; });
    cases.reference(
        "independent points of other seeds", found.request,
        [](SceneRequest&, integrator::RenderJob& j) { j.sampler = SamplerKind::Independent; });
    return std::move(cases).result();
}

std::vector<ChartCase> lights_cases(const ResolvedScene& found, const ChartSubject& subject,
                                    const SetUpView&) {
    Cases cases(ChartAxis::Lights, subject.job, "lights", "ways to choose one of the lights");
    if (found.lights < 2) {
        cases.remark(fmt::format("Left out: the scene has {} light, and a choice needs two",
                                 found.lights == 0 ? "no" : "one"));
        return std::move(cases).result();
    }
    cases.remark(fmt::format("The scene has {} lights, emissive triangles counted one by one",
                             found.lights));
    const auto with = [](LightChoiceKind kind) {
        return [kind](SceneRequest& s, integrator::RenderJob&) { s.light_choice = kind; };
    };
    cases.add("uniform", found.request, with(LightChoiceKind::Uniform));
    cases.add("power", found.request, with(LightChoiceKind::Power));
    cases.add("tree", found.request, with(LightChoiceKind::Tree));
    cases.independent_reference("by power", found.request, with(LightChoiceKind::Power));
    return std::move(cases).result();
}

std::vector<ChartCase> targets_cases(const ResolvedScene& found, const ChartSubject& subject,
                                     const SetUpView&) {
    Cases cases(ChartAxis::Targets, subject.job, "targets",
                "camera rays to small lamps out of focus");
    const SceneRequest lens = cases.with_lens(found);
    const auto with = [](TargetUse use) {
        return [use](SceneRequest& s, integrator::RenderJob&) { s.targets = use; };
    };
    cases.add("off", lens, with(TargetUse::Off));
    cases.add("auto", lens, with(TargetUse::Auto));
    cases.independent_reference("without targets", lens, with(TargetUse::Off));
    return std::move(cases).result();
}

std::vector<ChartCase> ghosts_cases(const ResolvedScene& found, const ChartSubject& subject,
                                    const SetUpView& open) {
    Cases cases(ChartAxis::Ghosts, subject.job, "ghosts",
                "light that surfaces of the lens reflect to the film");
    SceneRequest lens = cases.with_lens(found);
    lens.camera.ghosts = GhostUse::Off;
    if (lens.camera.coating == camera::Coating::Ideal) {
        lens.camera.coating = camera::Coating::Year;
        cases.remark("No surface would reflect: ⟨coating⟩=year was taken");
        try {
            static_cast<void>(open(lens));
        } catch (const io::ArgumentError& error) {
            cases.remark(std::string("Left out: ") + error.what());
            return std::move(cases).result();
        }
    }
    const auto with = [](GhostUse use) {
        return [use](SceneRequest& s, integrator::RenderJob&) { s.camera.ghosts = use; };
    };
    cases.add("off", lens, with(GhostUse::Off));
    cases.add("auto", lens, with(GhostUse::Auto));
    cases.remark("off is biased: it leaves their light out");
    cases.independent_reference("with ghosts", lens, with(GhostUse::Auto));
    return std::move(cases).result();
}

std::vector<ChartCase> diffraction_cases(const ResolvedScene& found, const ChartSubject& subject,
                                         const SetUpView& open) {
    Cases cases(ChartAxis::Diffraction, subject.job, "diffraction",
                "light that the iris spreads over the film");
    const SceneRequest lens = cases.with_lens(found);
    const auto with = [](DiffractionUse use) {
        return [use](SceneRequest& s, integrator::RenderJob&) { s.camera.diffraction = use; };
    };
    SceneRequest asked = lens;
    asked.camera.diffraction = DiffractionUse::Auto;
    if (!open(asked).view.diffraction) {
        cases.remark("Left out: here it changes nothing that is seen");
        return std::move(cases).result();
    }
    cases.add("off", lens, with(DiffractionUse::Off));
    cases.add("auto", lens, with(DiffractionUse::Auto));
    cases.remark("off is biased: its details are too sharp, and lamps have no stars");
    cases.independent_reference("with diffraction", lens, with(DiffractionUse::Auto));
    return std::move(cases).result();
}

/// Remark that counts traversal leaks: a wrong pixel here and there hardly shows in an error.
std::string leak_count(const SceneRequest& request, const SetUpView& open) {
    constexpr size_t kRays = 20000;
    std::vector<Ray> rays;
    const auto through = [&](Traversal traversal) {
        SceneRequest one = request;
        one.traversal = traversal;
        const RenderSetup setup = open(one);
        if (rays.empty()) rays = shared_edge_rays(*setup.prepared.scene, kRays, 0);
        return traversal_leaks(*setup.prepared.bvh, rays);
    };
    const size_t robust = through(Traversal::Robust), fast = through(Traversal::Fast);
    if (rays.empty()) return "No leaks were counted: the scene has no edges that triangles share";
    return fmt::format(
        "Leaks: of {} rays aimed at edges that two triangles share, robust traversal let {} "
        "through and fast {}",
        rays.size(), robust, fast);
}

std::vector<ChartCase> precision_cases(const ResolvedScene& found, const ChartSubject& subject,
                                       const SetUpView& open) {
    Cases cases(ChartAxis::Precision, subject.job, "precision",
                "floats and doubles in the lens, robust and fast traversal");
    SceneRequest lens = cases.with_lens(found);
    lens.camera.dispersion = camera::DispersionMode::Shared;
    cases.remark("One ray for all wavelengths");
    cases.remark(leak_count(lens, open));
    const auto with = [](camera::Precision precision, Traversal traversal) {
        return [=](SceneRequest& s, integrator::RenderJob&) {
            s.camera.precision = precision;
            s.traversal = traversal;
        };
    };
    cases.add("float robust", lens, with(camera::Precision::Float, Traversal::Robust));
    cases.add("double robust", lens, with(camera::Precision::Double, Traversal::Robust));
    cases.add("float fast", lens, with(camera::Precision::Float, Traversal::Fast));
    cases.independent_reference("double and robust", lens,
                                with(camera::Precision::Double, Traversal::Robust));
    return std::move(cases).result();
}

std::vector<ChartCase> noise_cases(const ResolvedScene& found, const ChartSubject& subject,
                                   const SetUpView&) {
    Cases cases(ChartAxis::Noise, subject.job, "noise",
                "equal samples for all pixels, as many as each part needs, and denoising");
    const auto as_it_is = [](SceneRequest&, integrator::RenderJob&) {};
    cases.add("samples", found.request, as_it_is);
    cases.add("noise", found.request, as_it_is).picture = ChartPicture::Noise;
    cases
        .add("denoised", found.request,
             [](SceneRequest&, integrator::RenderJob& job) { job.replicates = kHalves; })
        .picture = ChartPicture::Denoised;
    cases.remark("denoised is biased where it blurs; its CPU time includes that of denoising");
    cases.independent_reference("the same number of samples", found.request, as_it_is);
    return std::move(cases).result();
}

/// What makes the cases of an axis.
struct Maker {
    bool needs_lens;
    std::vector<ChartCase> (*make)(const ResolvedScene&, const ChartSubject&, const SetUpView&);
};
/// In the order of ChartAxis.
constexpr Maker kMakers[] = {
    {true, camera_cases},    {true, dispersion_cases}, {false, spectral_cases},
    {true, iris_cases},      {false, sampler_cases},   {false, lights_cases},
    {true, targets_cases},   {true, ghosts_cases},     {true, diffraction_cases},
    {true, precision_cases}, {false, noise_cases}};

}  // namespace

std::vector<ChartCase> chart_cases(const std::vector<ChartAxis>& axes, const ChartSubject& subject,
                                   const SetUpView& open) {
    const ResolvedScene found = resolved(subject.request, open);
    std::vector<ChartCase> cases;
    for (const ChartAxis axis : axes) {
        const Maker& maker = kMakers[static_cast<size_t>(axis)];
        if (maker.needs_lens && found.report.orthographic)
            throw io::ArgumentError(subject.request.scene.string(), "",
                                    "axis {} needs a lens, and the camera is orthographic: give "
                                    "⟨camera⟩ or ⟨look-at⟩",
                                    name_of(axis));
        for (ChartCase& one : maker.make(found, subject, open)) cases.push_back(std::move(one));
    }
    return cases;
}

std::vector<std::string> axis_words() {
    std::vector<std::string> words;
    for (const auto& [word, axis] : kOptionNames<ChartAxis>) words.emplace_back(word);
    words.emplace_back("all");
    return words;
}

std::vector<ChartAxis> parse_axes(const std::string& option,
                                  const std::vector<std::string>& words) {
    std::vector<ChartAxis> axes;
    for (const auto& [word, axis] : kOptionNames<ChartAxis>) {
        const auto asked = [&, name = word](const std::string& w) {
            return w == name || w == "all";
        };
        if (words.empty() || std::any_of(words.begin(), words.end(), asked)) axes.push_back(axis);
    }
    const std::vector<std::string> known = axis_words();
    for (const std::string& word : words)
        if (std::ranges::find(known, word) == known.end())
            throw ValueError(option,
                             fmt::format("\"{}\" is none of {}{}", word, fmt::join(known, ", "),
                                         io::did_you_mean(word, known)));
    return axes;
}

}  // namespace petzval::apps
