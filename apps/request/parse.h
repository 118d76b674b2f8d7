// SPDX-License-Identifier: Apache-2.0
// Values from texts, and texts that give them again. Each function throws ValueError, which names
// the option.
#pragma once

#include <string>
#include <vector>

#include "apps/request/quantity.h"
#include "apps/request/render_order.h"
#include "core/film/film.h"
#include "core/spectrum/bins.h"

namespace petzval::apps {

/// Numbers from "a,b,c": exactly n, finite.
[[nodiscard]] std::vector<float> parse_numbers(const std::string& option, const std::string& text,
                                               size_t n);
/// Lengths in metres from "0,1.5,2m,0,0,30cm": exactly n, finite.
[[nodiscard]] std::vector<float> parse_lengths_m(const std::string& option, const std::string& text,
                                                 size_t n);
/// Size from "1280x720", also with X or ×: whole numbers from 1 to 65536.
[[nodiscard]] V2i parse_size(const std::string& option, const std::string& text);
/// Sensor size in millimetres from "36x24" or "36x24mm": two numbers from least to most.
[[nodiscard]] V2f parse_sensor(const std::string& option, const std::string& text, double least,
                               double most);
/// Crop from "x,y,w,h" in pixels, which must hold one, or from "i/n": the i-th of n bands, i
/// from 1.
[[nodiscard]] Crop parse_crop(const std::string& option, const std::string& text);
/// Text that parse_crop() reads.
[[nodiscard]] std::string text_of(const Crop&);
/// Throws where a crop does not lie inside a frame.
void check_inside(const std::string& option, const Rect& crop, V2i frame);
/// Range of sample indices from "A:B": A below B, and B at most `most`.
[[nodiscard]] SampleRange parse_samples(const std::string& option, const std::string& text,
                                        uint32_t most);
/// Pixel from "x,y": two whole numbers.
[[nodiscard]] V2i parse_pixel(const std::string& option, const std::string& text);
/// Duration from "90", "90s", "1.5m", "1h30m", or as a clock shows it, "1:30" and "1:30:00":
/// seconds above 0.
[[nodiscard]] double parse_duration_s(const std::string& option, const std::string& text);
/// Exposure from "6.5", -100 to 100 EV, or "auto".
[[nodiscard]] ExposureRequest parse_exposure(const std::string& option, const std::string& text);
/// Bytes from "512MB" (10^6), "8GB" or "8GiB" (2^30): above 0.
[[nodiscard]] uint64_t parse_memory_bytes(const std::string& option, const std::string& text);
/// Share from "1%" or "0.01": above 0, 1 at most.
[[nodiscard]] double parse_share(const std::string& option, const std::string& text);
/// Moment from "1.25", "1.25s", "40ms" or "frame:30".
[[nodiscard]] Moment parse_moment(const std::string& option, const std::string& text);
/// Shutter time above 0 from "0.01", "1/100", "1/100s", "10ms", or "180deg" of a frame.
[[nodiscard]] ShutterTime parse_shutter(const std::string& option, const std::string& text);
/// Focus distance in metres from "1.5", "30cm", "5ft" (above 0), "infinity", "inf" or "∞".
[[nodiscard]] float parse_focus_distance_m(const std::string& option, const std::string& text);
/// Focus from a focus distance, "auto", or "x,y" (a pixel of the frame).
[[nodiscard]] Focus parse_focus(const std::string& option, const std::string& text);
/// Throws where a focus is a pixel that does not lie inside a frame.
void check_inside(const std::string& option, const Focus&, V2i frame);
/// Bins from "380:730:10", also with nm: edges of equal bins in nm, inside the wavelengths that
/// paths carry.
[[nodiscard]] Bins parse_bins(const std::string& option, const std::string& text);
/// Names of all layers.
[[nodiscard]] std::vector<std::string> layer_names();

/// Adds the layers of a list of their names, "albedo,normal", that are not there yet.
void add_aovs(const std::string& option, const std::string& list, std::vector<Aov>& layers);
/// Eye and target in metres from "ex,ey,ez,tx,ty,tz": two points.
[[nodiscard]] std::array<V3f, 2> parse_look_at(const std::string& option, const std::string& text);
/// Pose of a camera: 12 numbers, the rows of a 3x4 matrix from the camera's space to the world, in
/// metres. Its first three columns must be a rotation.
[[nodiscard]] M44f parse_pose(const std::string& option, const std::string& text);
/// Text that parse_pose() reads.
[[nodiscard]] std::string text_of_pose(const M44f&);
/// Numbers of frames from "1:48" (both are rendered), "1:48:2" (every second one) or "7": whole
/// numbers from 0, at most 100,000 of them.
[[nodiscard]] std::vector<int> parse_frames(const std::string& option, const std::string& text);
/// Sweep from "fstop=1.4,2,2.8", with semicolons between values that hold commas.
[[nodiscard]] Sweep parse_sweep(const std::string& option, const std::string& text);

}  // namespace petzval::apps
