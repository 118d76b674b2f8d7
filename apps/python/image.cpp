// SPDX-License-Identifier: Apache-2.0
#include "apps/python/image.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "apps/python/aside.h"
#include "apps/python/bindings.h"
#include "apps/setup/input_files.h"
#include "camera/pose.h"
#include "io/image/display.h"
#include "io/image/picture_files.h"

namespace petzval::apps {
namespace {

namespace py = pybind11;

constexpr std::array<const char*, 3> kNames{"x.exr", "x.png", "x.jpg"};  // by PictureFormat

// Array of an image's numbers that shares their memory and keeps them alive.
py::array read_only(const float* values, std::array<py::ssize_t, 3> shape,
                    const py::object& owner) {
    py::array_t<float> array(shape, values, owner);
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

py::array values_of(const py::object& image) {
    const auto& self = image.cast<const RenderedImage&>();
    const io::PictureLayout& layout = self.layout();
    return read_only(self.values().data(),
                     {layout.height, layout.width, py::ssize_t(layout.channels.size())}, image);
}

py::array shown_of(const RenderedImage& self) {
    auto shown = std::make_unique<io::Picture>();
    {
        const py::gil_scoped_release released;
        *shown = self.shown();
    }
    const std::array<py::ssize_t, 3> shape{shown->height, shown->width,
                                           py::ssize_t(shown->channels.size())};
    const float* const pixels = shown->pixels.data();
    return py::array_t<float>(shape, pixels, py::capsule(shown.release(), [](void* picture) {
                                  delete static_cast<io::Picture*>(picture);
                              }));
}

py::dict metadata_of(const RenderedImage& self) {
    py::dict all;
    for (const auto& [name, value] : self.layout().metadata)
        all[py::str(name)] = std::visit([](const auto& held) { return py::cast(held); }, value);
    return all;
}

py::array pose_of(const RenderedImage& self) {
    py::array_t<double> pose({4, 4});
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            pose.mutable_at(row, column) = double(self.camera().to_world[column][row]);
    return pose;
}

// Focal lengths in pixels, across and upright, by rays near the axis.
std::optional<std::array<double, 2>> focal_px(const View& view, const CameraReport& camera,
                                              V2i size) {
    constexpr float kAside = 0.01f;  // of the film
    if (camera.orthographic) return std::nullopt;
    const camera::Pose pose(camera.to_world);
    std::array<double, 2> out{};
    for (int axis = 0; axis < 2; ++axis) {
        double apart = 0;
        for (const float side : {kAside, -kAside}) {
            V2f film(0.5f);
            film[axis] += side;
            const camera::CameraSample seen =
                view.finder->sample({film, Sampler(SamplerKind::Owen, 0, {0, 0, 0})}, Bands::rgb());
            if (seen.empty()) return std::nullopt;
            const V3d along = pose.local(seen[0].ray.direction);
            apart += (side > 0 ? 1 : -1) * along[axis] / -along.z;
        }
        out[size_t(axis)] = 2 * double(kAside) * size[axis] / std::fabs(apart);
    }
    return out;
}

py::tuple frame_of(const RenderedImage& self) {
    const io::PictureLayout& layout = self.layout();
    return py::make_tuple(layout.x, layout.y, layout.full_width, layout.full_height);
}

}  // namespace

RenderedImage::RenderedImage(const RenderSession& session, const SceneRequest& request,
                             std::vector<std::string> notices)
    : display_(session.display()),
      camera_(session.setup().from.camera),
      focal_px_(apps::focal_px(session.setup().view, camera_, request.size)),
      inputs_(input_files(request)),
      notices_(std::move(notices)) {
    for (const io::NamedFile& file : session.setup().prepared.files) inputs_.push_back(file);
    for (size_t i = 0; i < kNames.size(); ++i) layouts_[i] = session.picture(kNames[i]).layout;
    const io::PictureRows light = session.picture(kNames[0]);
    const size_t row_size = size_t(light.layout.width) * light.layout.channels.size();
    values_.resize(row_size * size_t(light.layout.height));
    for (int y = 0; y < light.layout.height; ++y)
        light.row(y, values_.data() + row_size * size_t(y));
}

io::PictureRows RenderedImage::rows(io::PictureFormat format) const {
    const io::PictureLayout& asked = layout_of(format);
    const size_t all = layout().channels.size();
    if (asked.channels.size() == all)
        return {asked, [this, row_size = all * size_t(asked.width)](int y, float* row) {
                    std::copy_n(values_.data() + row_size * size_t(y), row_size, row);
                }};
    // What is shown of a picture that was denoised has other colours than its light.
    std::vector<size_t> from;
    for (const std::string& channel : asked.channels) {
        const int denoised = io::channel_index(layout(), "denoised." + channel);
        from.push_back(size_t(denoised >= 0 ? denoised : io::channel_index(layout(), channel)));
    }
    return {asked, [this, all, from, width = size_t(asked.width)](int y, float* row) {
                const float* pixel = values_.data() + size_t(y) * width * all;
                for (size_t x = 0; x < width; ++x, pixel += all)
                    for (const size_t channel : from) *row++ = pixel[channel];
            }};
}

void RenderedImage::save(const std::filesystem::path& file) const {
    require_own_threads();
    const io::PictureFormat format = io::picture_format(file);
    io::refuse_overwriting({{"path", file}}, inputs_);
    io::refuse_overwriting({{"path", file}}, own_files());
    io::write_output(file, rows(format), display_);
}

io::Picture RenderedImage::shown() const {
    const io::PictureRows shown =
        io::to_display(rows(io::PictureFormat::Png), display_.exposure_ev, display_.view,
                       io::AlphaUse::Keep, display_.config);
    io::Picture out;
    static_cast<io::PictureLayout&>(out) = shown.layout;
    const size_t row_size = size_t(out.width) * out.channels.size();
    out.pixels.resize(row_size * size_t(out.height));
    for (int y = 0; y < out.height; ++y) shown.row(y, out.pixels.data() + row_size * size_t(y));
    return out;
}

void bind_image(py::module_& module) {
    py::class_<RenderedImage, std::shared_ptr<RenderedImage>>(module, "Image")
        .def_property_readonly("values", values_of)
        .def_property_readonly("channels",
                               [](const RenderedImage& self) { return self.layout().channels; })
        .def_property_readonly("metadata", metadata_of)
        .def_property_readonly("notices", &RenderedImage::notices)
        .def_property_readonly("pose", pose_of)
        .def_property_readonly("focal_px", &RenderedImage::focal_px)
        .def_property_readonly("focus_m",
                               [](const RenderedImage& self) { return self.camera().focus_m; })
        .def_property_readonly("frame", frame_of)
        .def("shown", shown_of)
        .def("save", [](const RenderedImage& self, const std::string& path) {
            const py::gil_scoped_release released;
            self.save(path);
        });
    module.def("write_exr", [](const std::string& path, const py::array_t<float>& pixels) {
        require_own_threads();
        io::Picture picture;
        picture.width = picture.full_width = int(pixels.shape(1));
        picture.height = picture.full_height = int(pixels.shape(0));
        picture.channels = {"R", "G", "B"};
        picture.pixels.assign(pixels.data(), pixels.data() + pixels.size());
        const py::gil_scoped_release released;
        io::write_exr(path, picture);
    });
}

}  // namespace petzval::apps
