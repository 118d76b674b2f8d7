// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

#include "io/base/error.h"
#include "io/codec/codec.h"
#include "io/file/atomic_file.h"
#include "io/file/text_lines.h"
#include "io/picture/picture_kind.h"
#include "io/picture/seal.h"

namespace petzval::io::codec {
namespace {

/// Output of OpenImageIO's writers into an AtomicFile. None of them hears of a write that failed:
/// on a full disk its JPEG writer would end the program, its PNG and EXR writers report success.
class FileProxy : public OIIO::Filesystem::IOProxy {
  public:
    explicit FileProxy(AtomicFile& file) : IOProxy("", Write), file_(file) {}
    [[nodiscard]] const char* proxytype() const override { return "petzval"; }
    size_t write(const void* bytes, size_t count) override {
        m_pos += int64_t(pwrite(bytes, count, m_pos));
        return count;
    }
    size_t pwrite(const void* bytes, size_t count, int64_t offset) override {
        file_.write({static_cast<const uint8_t*>(bytes), count}, uint64_t(offset));
        return count;
    }

  private:
    AtomicFile& file_;
};

/// Chromaticities x, y of red, green, blue and white: ITU-R BT.709-6, items 1.3 and 1.4.
constexpr std::array<float, 8> kRec709{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

/// Rows that OpenEXR gets at once, to compress them by as many threads as there are.
constexpr int kBandRows = 32;

/// Writes a file with that ending, band by band. fill(y, values) makes one row.
template <class Value, class Fill>
void encode(const std::filesystem::path& path, const std::string& ending, OIIO::ImageSpec spec,
            const Fill& fill) {
    AtomicFile file(path);
    FileProxy to_file(file);
    OIIO::Filesystem::IOProxy* proxy = &to_file;
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const auto output = OIIO::ImageOutput::create(ending);
    const auto refuse = [&](const std::string& why) -> OutputError {
        return {path.string(), "", "cannot be encoded: " + first_line(why)};
    };
    if (!output) throw refuse(OIIO::geterror());
    bool good = output->open("petzval." + ending, spec);
    const size_t row = size_t(spec.width) * size_t(spec.nchannels);
    std::vector<Value> band(row * size_t(std::min(kBandRows, spec.height)));
    for (int y0 = 0; good && y0 < spec.height; y0 += kBandRows) {
        const int y1 = std::min(y0 + kBandRows, spec.height);
        for (int y = y0; y < y1; ++y) fill(y, band.data() + row * size_t(y - y0));
        good = output->write_scanlines(spec.y + y0, spec.y + y1, 0, spec.format, band.data());
    }
    good = output->close() && good;
    if (!good) throw refuse(output->geterror());
    seal(file);
    file.commit();
}

void check_shape(const PictureLayout& picture) {
    if (picture.width <= 0 || picture.height <= 0 || picture.channels.empty())
        throw std::invalid_argument("a picture must hold something");
}

OIIO::ImageSpec exr_spec(const PictureLayout& picture) {
    OIIO::ImageSpec spec(picture.width, picture.height, int(picture.channels.size()),
                         OIIO::TypeDesc::FLOAT);
    spec.x = picture.x;
    spec.y = picture.y;
    spec.full_width = picture.full_width;
    spec.full_height = picture.full_height;
    spec.channelnames = picture.channels;
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), kRec709.data());
    spec.attribute("DateTime", "");  // else the time of writing goes in
    for (const auto& one : picture.metadata)
        if (!is_seal_of_another(one))
            std::visit([&](const auto& v) { spec.attribute(one.first, v); }, one.second);
    // Each row by itself: with zip, which packs 16 rows, OpenEXR's buffers for a spectral picture
    // would take half a gigabyte on 16 cores, to save 0.3 % of the file.
    spec.attribute("compression", "zips");
    return spec;
}

/// Own metadata as one text, by name, as an EXR has them. Only what has no blank: that divides
/// them.
std::string description_of(const PictureLayout& picture) {
    std::map<std::string, std::string> words;
    for (const auto& one : picture.metadata)
        if (const auto* word = std::get_if<std::string>(&one.second);
            word && one.first.starts_with(kOwnMetadata) && word->find(' ') == std::string::npos &&
            !is_seal_of_another(one))
            words[one.first] = *word;
    std::string text;
    for (const auto& [name, word] : words) text += (text.empty() ? "" : " ") + name + "=" + word;
    return text;
}

/// Nearest of 256 levels; what is not a number is black.
uint8_t to_8bit(float value) {
    return value > 0.f ? static_cast<uint8_t>(std::min(value, 1.f) * 255.f + 0.5f) : 0;
}

}  // namespace

void write_exr(const std::filesystem::path& path, const PictureRows& picture) {
    check_shape(picture.layout);
    encode<float>(path, "exr", exr_spec(picture.layout), picture.row);
}

void write_8bit(const std::filesystem::path& path, const PictureRows& encoded, bool srgb) {
    const PictureLayout& layout = encoded.layout;
    check_shape(layout);
    const bool png = picture_format(path) == PictureFormat::Png;
    std::vector<int> from;
    for (const char* name : {"R", "G", "B"}) from.push_back(channel_index(layout, name));
    if (*std::min_element(from.begin(), from.end()) < 0)
        throw std::invalid_argument("a display picture needs channels R, G and B");
    if (const int alpha = channel_index(layout, "A"); png && alpha >= 0) from.push_back(alpha);

    OIIO::ImageSpec spec(layout.width, layout.height, int(from.size()), OIIO::TypeDesc::UINT8);
    if (srgb) spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("CompressionQuality", 95);
    if (const std::string text = description_of(layout); !text.empty())
        spec.attribute("ImageDescription", text);
    spec.attribute("jpeg:subsampling", "4:4:4");  // small coloured lights keep their colour
    std::vector<float> values(size_t(layout.width) * layout.channels.size());
    encode<uint8_t>(path, png ? "png" : "jpg", spec, [&](int y, uint8_t* row) {
        encoded.row(y, values.data());
        for (size_t i = 0; i < values.size(); i += layout.channels.size())
            for (const int channel : from) *row++ = to_8bit(values[i + size_t(channel)]);
    });
}

}  // namespace petzval::io::codec
