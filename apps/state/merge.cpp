// SPDX-License-Identifier: Apache-2.0
#include "apps/state/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "apps/setup/memory.h"
#include "io/base/error.h"
#include "io/base/format.h"
#include "io/base/printable.h"

namespace petzval::apps {
namespace {

namespace fs = std::filesystem;

/// A box as half-open intervals of x, y and sample.
using Box = std::array<std::array<int64_t, 2>, 3>;

Box box_of(const StateBox& b) {
    return {{{b.crop.x0, b.crop.x1}, {b.crop.y0, b.crop.y1}, {b.samples.first, b.samples.end}}};
}

bool overlap(const Box& a, const Box& b) {
    bool all = true;
    for (size_t i = 0; i < 3; ++i)
        all = all && std::max(a[i][0], b[i][0]) < std::min(a[i][1], b[i][1]);
    return all;
}

std::string text_of(const Box& b) {
    return fmt::format("samples {}:{} of the pixels {},{},{},{}", b[2][0], b[2][1], b[0][0],
                       b[1][0], b[0][1] - b[0][0], b[1][1] - b[1][0]);
}

// A part of the whole that no box holds, as long as possible along the samples; nothing where they
// hold all of it. Looks at the corners of the grid that the edges of all boxes make.
std::optional<Box> missing_part(const Box& whole, const std::vector<Box>& boxes) {
    const auto edges_of = [&](size_t axis, const std::vector<Box>& from) {
        std::set<int64_t> edges{whole[axis][0], whole[axis][1]};
        for (const Box& b : from) edges.insert(b[axis].begin(), b[axis].end());
        return std::vector<int64_t>(edges.begin(), edges.end());
    };
    const auto within = [](const std::vector<Box>& from, size_t axis, int64_t at) {
        std::vector<Box> out;
        for (const Box& b : from)
            if (b[axis][0] <= at && at < b[axis][1]) out.push_back(b);
        return out;
    };
    const auto ys = edges_of(1, boxes);
    for (size_t j = 0; j + 1 < ys.size(); ++j) {
        const std::vector<Box> in_row = within(boxes, 1, ys[j]);
        const auto xs = edges_of(0, in_row);
        for (size_t i = 0; i + 1 < xs.size(); ++i) {
            std::vector<Box> column = within(in_row, 0, xs[i]);
            std::sort(column.begin(), column.end(),
                      [](const Box& a, const Box& b) { return a[2][0] < b[2][0]; });
            int64_t at = whole[2][0];
            for (const Box& b : column) {
                if (b[2][0] > at)
                    return Box{{{xs[i], xs[i + 1]}, {ys[j], ys[j + 1]}, {at, b[2][0]}}};
                at = std::max(at, b[2][1]);
            }
            if (at < whole[2][1])
                return Box{{{xs[i], xs[i + 1]}, {ys[j], ys[j + 1]}, {at, whole[2][1]}}};
        }
    }
    return std::nullopt;
}

}  // namespace

StateBox covered_box(const std::vector<StateBox>& parts, const std::vector<fs::path>& names) {
    std::vector<Box> boxes;
    for (const StateBox& part : parts) boxes.push_back(box_of(part));
    // In the order of their first samples, a box overlaps none that begins behind its end.
    std::vector<size_t> order(boxes.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return boxes[a][2][0] < boxes[b][2][0]; });
    for (size_t i = 0; i < order.size(); ++i)
        for (size_t j = i + 1; j < order.size(); ++j) {
            const Box &a = boxes[order[i]], &b = boxes[order[j]];
            if (b[2][0] >= a[2][1]) break;
            if (overlap(a, b))
                throw io::InputError(
                    names[order[i]].string(), "",
                    "has samples that are in {} too: {} and {}; a sample counts once",
                    names[order[j]].string(), text_of(a), text_of(b));
        }
    Box whole = boxes.front();
    for (const Box& b : boxes)
        for (size_t i = 0; i < 3; ++i) {
            whole[i][0] = std::min(whole[i][0], b[i][0]);
            whole[i][1] = std::max(whole[i][1], b[i][1]);
        }
    if (const auto missing = missing_part(whole, boxes))
        throw io::InputError(
            names.front().string(), "",
            "this state and the others leave a gap: {} are in none of them; render "
            "them by ⟨spp⟩ {}:{} and, for a part of the frame, ⟨crop⟩",
            text_of(*missing), (*missing)[2][0], (*missing)[2][1]);
    return {{int(whole[0][0]), int(whole[1][0]), int(whole[0][1]), int(whole[1][1])},
            {uint32_t(whole[2][0]), uint32_t(whole[2][1])}};
}

MergedState merge_states(const std::vector<fs::path>& files) {
    std::vector<StateBox> parts;
    std::vector<io::StateHeader> headers;
    std::optional<RunRecord> sum;
    for (const fs::path& file : files) {
        const io::StateReader reader(file);
        const io::StateHeader& header = reader.header();
        if (!header.is_complete())
            throw io::InputError(file.string(), "",
                                 "is not complete: it has {}; petzval resume {} renders the rest",
                                 share_text(header), io::for_shell(file.string()));
        RunRecord record = record_in(header, file);
        if (!sum) {
            sum = std::move(record);
        } else {
            const ComparedRender first{sum->facts, headers.front().shape, files.front().string()},
                other{record.facts, header.shape, file.string()};
            if (const auto differs = difference(first, other, Compare::Pictures))
                throw io::InputError(file.string(), "",
                                     "is a state of another render: " + *differs);
            if (sum->facts.noise && sum->facts.noise->noise != record.facts.noise->noise)
                throw io::InputError(
                    file.string(), "",
                    "was rendered to a noise of {}, and {} to one of {}; petzval "
                    "resume STATE ⟨noise⟩ {:.3g}% brings the other one to the same",
                    io::percent(record.facts.noise->noise), first.name,
                    io::percent(sum->facts.noise->noise),
                    100 * std::min(record.facts.noise->noise, sum->facts.noise->noise));
            sum->figures += record.figures;
        }
        parts.push_back({header.shape.crop, header.samples});
        headers.push_back(header);
    }
    const StateBox box = covered_box(parts, files);
    io::FilmShape shape = headers.front().shape;
    shape.crop = box.crop;
    if (const auto shortage = memory_shortage(double(shape.bytes())))
        throw io::OutOfMemory("the merged picture " + *shortage);
    // What a denoiser needs around a part, other parts have: each pixel is taken from its own.
    const bool of_crops = std::ranges::any_of(
        headers, [&](const io::StateHeader& header) { return header.shape.crop != shape.crop; });
    if (of_crops && shape.pixels() != shape.crop)
        throw io::InputError(
            files.front().string(), "",
            "this state and the others are parts of a frame that is denoised: give "
            "those of all of the frame");
    Film film = shape.empty_film();
    for (size_t i = 0; i < files.size(); ++i) {
        io::StateReader reader(files[i]);
        if (reader.header().shape != headers[i].shape ||
            reader.header().samples != headers[i].samples)
            throw io::InputError(files[i].string(), "", "was replaced meanwhile; merge again");
        if (of_crops)
            reader.add_to(film, headers[i].shape.crop);
        else
            reader.add_to(film);
    }
    return {std::move(film), box.samples, std::move(*sum)};
}

}  // namespace petzval::apps
