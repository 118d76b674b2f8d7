// SPDX-License-Identifier: Apache-2.0
#include "apps/python/bindings.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cmath>
#include <limits>
#include <memory>

#include "apps/request/value_error.h"
#include "camera/bench/analysis.h"
#include "camera/bench/spot.h"
#include "camera/lens/focus.h"
#include "camera/lens/traced_ray.h"
#include "camera/setup/lens_bench.h"
#include "io/lens/lens_file.h"

namespace petzval::apps {
namespace {

namespace py = pybind11;
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::string shape_text(const py::array& a) {
    std::string text;
    for (py::ssize_t i = 0; i < a.ndim(); ++i)
        text += fmt::format("{}{}", i > 0 ? ", " : "", a.shape(i));
    return "(" + text + ")";
}

std::span<const V3d> rows_of_three(const char* field, const Array& a) {
    if (a.ndim() != 2 || a.shape(1) != 3)
        throw ValueError(field, "has the shape " + shape_text(a) + ", not (N, 3)");
    return {reinterpret_cast<const V3d*>(a.data()), size_t(a.shape(0))};
}

std::span<V3d> rows_of(Array& a) {
    return {reinterpret_cast<V3d*>(a.mutable_data()), size_t(a.shape(0))};
}

Array array_of_pairs(const std::vector<camera::BundleRay>& rays,
                     std::array<double, 2> camera::BundleRay::*member) {
    Array out({py::ssize_t(rays.size()), py::ssize_t(2)});
    for (size_t i = 0; i < rays.size(); ++i)
        for (size_t k = 0; k < 2; ++k) out.mutable_at(i, k) = (rays[i].*member)[k];
    return out;
}

/// Lens with its film, and the distance of what it is focused on.
class BenchLens {
  public:
    BenchLens(const std::string& name, const std::vector<std::string>& glasses)
        : BenchLens(read(name, glasses)) {}

    [[nodiscard]] const camera::Lens& lens() const { return *bench.lens; }
    [[nodiscard]] const camera::Prescription& file() const { return lens().prescription(); }

    [[nodiscard]] BenchLens focused(double distance, bool traced) const {
        auto sharp = camera::LensBench::focused(
            lens(), distance, traced ? camera::FocusBy::Traced : camera::FocusBy::Paraxial);
        if (!sharp)
            throw ValueError("distance_m",
                             fmt::format("{} cannot be focused at {:g} mm; give a greater distance",
                                         file().name, distance));
        return {*std::move(sharp), warnings};
    }
    [[nodiscard]] double best_film_shift() const {
        const auto shift = bench.best_film_shift_mm();
        if (!shift) throw dark(0);
        return *shift;
    }
    [[nodiscard]] std::vector<camera::BundleRay> rays(double field_deg, double nm, int side,
                                                      bool to_x) const {
        if (!(std::fabs(field_deg) < 90))
            throw ValueError("field_deg", fmt::format("{} is not between -90 and 90", field_deg));
        const auto bundle =
            bench.aim(field_deg, nm, to_x ? camera::Section::X : camera::Section::Y);
        if (!bundle) throw dark(field_deg);
        auto found = bundle->trace(bundle->grid(side), bench.film_mm);
        if (found.empty()) throw dark(field_deg);
        return found;
    }
    [[nodiscard]] std::vector<double> irradiance(const std::vector<double>& heights_mm) const {
        return camera::film_irradiance(bench.lens, bench.film_mm, heights_mm);
    }

    camera::LensBench bench;
    std::vector<std::string> warnings;

  private:
    BenchLens(camera::LensBench of, std::vector<std::string> told)
        : bench(std::move(of)), warnings(std::move(told)) {}
    [[nodiscard]] static BenchLens read(const std::string& name,
                                        const std::vector<std::string>& glasses) {
        std::vector<io::AgfCatalog> catalogs;
        for (const std::string& file : glasses) catalogs.emplace_back(file);
        io::LensFile file = io::load_lens(name, catalogs);
        return {camera::LensBench(std::make_shared<const camera::Lens>(std::move(file.lens))),
                std::move(file.warnings)};
    }
    [[nodiscard]] ValueError dark(double field_deg) const {
        return {"field_deg", fmt::format("no light of the field {:g}° reaches the film of {}; give "
                                         "a smaller one",
                                         field_deg, file().name)};
    }
};

py::tuple trace(const BenchLens& self, const Array& origins, const Array& directions,
                const Array& nm, bool to_scene, bool clip) {
    const std::span<const V3d> from = rows_of_three("origins_mm", origins),
                               along = rows_of_three("directions", directions);
    if (from.size() != along.size())
        throw ValueError("directions",
                         fmt::format("are {} for {} origins", along.size(), from.size()));
    const std::span<const double> waves(nm.data(), size_t(nm.size()));
    if (waves.size() != 1 && waves.size() != from.size())
        throw ValueError("wavelengths_nm",
                         fmt::format("are {} for {} rays; give one for each, or one for all",
                                     waves.size(), from.size()));
    const auto count = py::ssize_t(from.size());
    Array points({count, py::ssize_t(3)}), directions_out({count, py::ssize_t(3)}), paths(count);
    py::array_t<int> status(count), ends(count);
    const camera::RaysOut out{
        rows_of(points),
        rows_of(directions_out),
        {paths.mutable_data(), from.size()},
        {reinterpret_cast<camera::RayStatus*>(status.mutable_data()), from.size()},
        {ends.mutable_data(), from.size()}};
    {
        const py::gil_scoped_release released;
        camera::trace_rays(self.lens(), {from, along, waves},
                           to_scene ? camera::Towards::Scene : camera::Towards::Film,
                           clip ? camera::Clip::Yes : camera::Clip::No, out);
    }
    return py::make_tuple(points, directions_out, paths, status, ends);
}

py::tuple spot(const BenchLens& self, double field_deg, double nm, int side, bool to_x) {
    std::vector<camera::BundleRay> rays;
    {
        const py::gil_scoped_release released;
        rays = self.rays(field_deg, nm, side, to_x);
    }
    const camera::SpotSize size = camera::spot_size(rays);
    return py::make_tuple(array_of_pairs(rays, &camera::BundleRay::film_mm),
                          array_of_pairs(rays, &camera::BundleRay::pupil_point), size.centroid_mm,
                          size.rms_mm, camera::best_shift_mm(rays));
}

// Contrast along the field and across it, at each frequency.
py::tuple mtf(const BenchLens& self, const std::vector<double>& cycles_per_mm, double field_deg,
              const std::vector<double>& nm, int side) {
    std::vector<double> tangential, sagittal;
    {
        const py::gil_scoped_release released;
        std::vector<camera::BundleRay> rays;
        for (const double wave : nm)
            for (const camera::BundleRay& ray : self.rays(field_deg, wave, side, false))
                rays.push_back(ray);
        for (const double cycles : cycles_per_mm) {
            tangential.push_back(camera::geometric_mtf(rays, cycles, camera::Section::Y));
            sagittal.push_back(camera::geometric_mtf(rays, cycles, camera::Section::X));
        }
    }
    return py::make_tuple(tangential, sagittal);
}

// Heights of the chief ray, and what they would be without distortion; NaN where it is lost.
py::tuple heights(const BenchLens& self, const std::vector<double>& fields_deg) {
    std::vector<double> real, ideal;
    for (const double field_deg : fields_deg) {
        if (!(field_deg > 0 && field_deg < 90))
            throw ValueError("fields_deg", fmt::format("{} is not between 0 and 90", field_deg));
        const auto found =
            camera::distortion(self.lens(), field_deg, self.bench.film_mm, self.bench.distance_mm);
        real.push_back(found ? found->height_mm : std::nan(""));
        ideal.push_back(found ? found->ideal_height_mm : std::nan(""));
    }
    return py::make_tuple(real, ideal);
}

py::list surfaces(const BenchLens& self) {
    py::list all;
    for (const camera::LensSurface& s : self.file().surfaces) {
        py::dict one;
        one["radius_mm"] =
            s.curvature_1_mm == 0 ? std::numeric_limits<double>::infinity() : 1 / s.curvature_1_mm;
        one["conic"] = s.conic;
        one["asphere"] = s.asphere;
        one["thickness_mm"] = s.thickness_mm;
        one["semi_diameter_mm"] = s.semi_diameter_mm;
        one["stop"] = s.stop;
        one["glass"] = s.glass ? py::object(py::str(s.glass->name)) : py::none();
        all.append(one);
    }
    return all;
}

py::dict facts(const BenchLens& self, double nm) {
    const camera::Prescription& file = self.file();
    const camera::FirstOrder first = camera::first_order(self.lens(), nm);
    const double stop_mm = file.surfaces[size_t(self.lens().stop())].semi_diameter_mm;
    py::dict out;
    out["name"] = file.name;
    out["title"] = file.title;
    out["source"] = file.source;
    out["image_circle_mm"] =
        file.image_circle_mm > 0 ? py::object(py::float_(file.image_circle_mm)) : py::none();
    out["half_field_deg"] = camera::field_half_deg(file);
    out["fnumber"] = camera::fnumber_of(self.lens(), stop_mm);
    out["film_mm"] = self.bench.film_mm;
    out["focal_length_mm"] = first.focal_length_mm;
    out["back_focus_mm"] = first.back_focus_mm;
    out["entrance_pupil_mm"] = first.entrance_pupil_mm;
    out["exit_pupil_mm"] = first.exit_pupil_mm;
    out["entrance_pupil_diameter_mm"] = first.entrance_pupil_diameter_mm;
    out["warnings"] = self.warnings;
    return out;
}

}  // namespace

void bind_lens(py::module_& module) {
    py::class_<BenchLens>(module, "Lens")
        .def(py::init<const std::string&, const std::vector<std::string>&>(),
             py::call_guard<py::gil_scoped_release>())
        .def_property(
            "film_mm", [](const BenchLens& self) { return self.bench.film_mm; },
            [](BenchLens& self, double mm) { self.bench.film_mm = mm; })
        .def_property_readonly("distance_mm",
                               [](const BenchLens& self) { return self.bench.distance_mm; })
        .def("focused", &BenchLens::focused, py::call_guard<py::gil_scoped_release>())
        .def("best_film_shift", &BenchLens::best_film_shift,
             py::call_guard<py::gil_scoped_release>())
        .def("trace", trace)
        .def("spot", spot)
        .def("mtf", mtf)
        .def("heights", heights)
        .def("irradiance", &BenchLens::irradiance, py::call_guard<py::gil_scoped_release>())
        .def("surfaces", surfaces)
        .def("facts", facts);
    module.attr("LINE_F_NM") = kLineF_nm;
    module.attr("LINE_D_NM") = kLineD_nm;
    module.attr("LINE_C_NM") = kLineC_nm;
    module.attr("PASSED") = int(camera::RayStatus::Passed);
    module.attr("VIGNETTED") = int(camera::RayStatus::Vignetted);
    module.attr("TOTALLY_REFLECTED") = int(camera::RayStatus::TotallyReflected);
    module.attr("MISSED") = int(camera::RayStatus::Missed);
    module.def("lens_names", [] {
        std::vector<std::string> names;
        for (const io::LensSummary& lens : io::list_lenses()) names.push_back(lens.name);
        return names;
    });
}

}  // namespace petzval::apps
