// libpng reports errors by longjmp, which skips destructors. Each function that sets a jump target
// therefore owns nothing: all that has a destructor belongs to its caller.
#include "render/png_writer.h"

#include <libdeflate.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <memory>
#include <new>
#include <span>

#include "core/base/check.h"
#include "core/base/error.h"

namespace scree {
namespace {

// Level 1 with the "sub" filter: files a little larger than by libpng's defaults in a tenth of the
// time; previews are written once for every frame and seldom kept. libdeflate compresses better
// than zlib's level 1 and takes 12 ms for 1000 rings at 720p where that takes 20.
constexpr int kCompressionLevel = 1;
constexpr std::uint8_t kFilterSub = 1;

constexpr std::size_t kLongestKeyword = 79;
constexpr std::size_t kLongestChunk = std::size_t{1} << 30;

void rememberError(png_structp png, png_const_charp message)
{
    *static_cast<std::string*>(png_get_error_ptr(png)) = message;
    png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

bool isAscii(const std::string& text)
{
    return std::all_of(text.begin(), text.end(), [](char c) { return c >= 0; });
}

// ---------------------------------------------------------------------------------------- encoding

void appendBytes(png_structp png, png_bytep data, std::size_t count)
{
    auto& bytes = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
    bytes.insert(bytes.end(), data, data + count);
}

void flushNothing(png_structp) {}

struct PngEncoder {
    std::string error;
    png_structp png =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, rememberError, ignoreWarning);
    png_infop info = png_create_info_struct(png);

    PngEncoder() = default;
    PngEncoder(const PngEncoder&) = delete;
    PngEncoder& operator=(const PngEncoder&) = delete;
    ~PngEncoder() { png_destroy_write_struct(&png, &info); }
};

/// Rows of three bytes a pixel as PNG wants them: each byte less that of the pixel to its left,
/// behind the number of this filter.
std::vector<std::uint8_t> filteredRows(std::span<const std::uint8_t> pixels, std::size_t rowBytes)
{
    std::vector<std::uint8_t> result(pixels.size() + pixels.size() / rowBytes);
    std::uint8_t* to = result.data();
    for (std::size_t begin = 0; begin < pixels.size(); begin += rowBytes) {
        const std::uint8_t* from = pixels.data() + begin;
        *to++ = kFilterSub;
        for (std::size_t i = 0; i < 3; ++i) to[i] = from[i];
        for (std::size_t i = 3; i < rowBytes; ++i)
            to[i] = static_cast<std::uint8_t>(from[i] - from[i - 3]);
        to += rowBytes;
    }
    return result;
}

std::vector<std::uint8_t> compressed(std::span<const std::uint8_t> bytes)
{
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(kCompressionLevel), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::vector<std::uint8_t> result(
        libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
    result.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(),
                                           result.data(), result.size()));
    SCREE_CHECK(!result.empty(), "libdeflate needs more room than it asked for");
    return result;
}

/// False when libpng gave up; the encoder then knows why. `data` are the compressed rows: libpng
/// writes them as they are.
bool encode(PngEncoder& encoder, int width, int height, std::span<const std::uint8_t> data,
            std::span<png_text> texts, std::vector<std::uint8_t>& bytes)
{
    png_structp png = encoder.png;
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, &bytes, appendBytes, flushNothing);
    png_set_IHDR(png, encoder.info, static_cast<png_uint_32>(width),
                 static_cast<png_uint_32>(height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    // With gAMA and cHRM for readers that do not know sRGB.
    png_set_sRGB_gAMA_and_cHRM(png, encoder.info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (!texts.empty())
        png_set_text(png, encoder.info, texts.data(), static_cast<int>(texts.size()));
    png_write_info(png, encoder.info);
    // No chunk may have 2³¹ bytes or more.
    for (std::size_t begin = 0; begin < data.size(); begin += kLongestChunk)
        png_write_chunk(png, reinterpret_cast<png_const_bytep>("IDAT"), data.data() + begin,
                        std::min(kLongestChunk, data.size() - begin));
    png_write_chunk(png, reinterpret_cast<png_const_bytep>("IEND"), nullptr, 0);
    return true;
}

/// libpng's view of the texts, which must outlive it.
std::vector<png_text> pngTexts(const PngText& text)
{
    std::vector<png_text> result;
    for (const auto& [keyword, value] : text) {
        SCREE_CHECK(!keyword.empty() && keyword.size() <= kLongestKeyword && isAscii(keyword),
                    "PNG keyword \"" + keyword + "\"");
        png_text item{};
        item.compression = isAscii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        item.key = const_cast<char*>(keyword.c_str());
        item.text = const_cast<char*>(value.c_str());
        if (isAscii(value))
            item.text_length = value.size();
        else
            item.itxt_length = value.size();
        result.push_back(item);
    }
    return result;
}

std::vector<std::uint8_t*> rowPointers(std::vector<std::uint8_t>& pixels, std::size_t rowBytes)
{
    std::vector<std::uint8_t*> rows(pixels.size() / rowBytes);
    for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = pixels.data() + y * rowBytes;
    return rows;
}

// ---------------------------------------------------------------------------------------- decoding

struct PngDecoder {
    std::span<const std::uint8_t> rest;  // what libpng has not taken yet
    std::string error;
    png_structp png =
        png_create_read_struct(PNG_LIBPNG_VER_STRING, &error, rememberError, ignoreWarning);
    png_infop info = png_create_info_struct(png);

    explicit PngDecoder(std::span<const std::uint8_t> bytes) : rest(bytes) {}
    PngDecoder(const PngDecoder&) = delete;
    PngDecoder& operator=(const PngDecoder&) = delete;
    ~PngDecoder() { png_destroy_read_struct(&png, &info, nullptr); }
};

void takeBytes(png_structp png, png_bytep target, std::size_t count)
{
    auto& rest = *static_cast<std::span<const std::uint8_t>*>(png_get_io_ptr(png));
    if (count > rest.size()) png_error(png, "the file ends too early");
    std::memcpy(target, rest.data(), count);
    rest = rest.subspan(count);
}

bool decodeHeader(PngDecoder& decoder)
{
    png_structp png = decoder.png;
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_read_fn(png, &decoder.rest, takeBytes);
    png_read_info(png, decoder.info);
    png_set_expand(png);
    png_set_strip_16(png);
    png_set_gray_to_rgb(png);
    png_set_strip_alpha(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, decoder.info);
    return true;
}

bool decodePixels(PngDecoder& decoder, std::span<std::uint8_t*> rows)
{
    png_structp png = decoder.png;
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_image(png, rows.data());
    png_read_end(png, decoder.info);
    return true;
}

/// The pixels, three bytes each; the header stays with the decoder.
std::vector<std::uint8_t> decode(PngDecoder& decoder, const std::string& name)
{
    const auto failure = [&] {
        return Error(ErrorKind::inputOutput,
                     name + " is not a readable PNG file: " + decoder.error);
    };
    if (!decodeHeader(decoder)) throw failure();
    const std::size_t rowBytes = png_get_rowbytes(decoder.png, decoder.info);
    std::vector<std::uint8_t> pixels(rowBytes * png_get_image_height(decoder.png, decoder.info));
    std::vector<std::uint8_t*> rows = rowPointers(pixels, rowBytes);
    if (!decodePixels(decoder, rows)) throw failure();
    return pixels;
}

PngText textsOf(const PngDecoder& decoder)
{
    PngText result;
    png_textp texts = nullptr;
    int count = 0;
    png_get_text(decoder.png, decoder.info, &texts, &count);
    for (int i = 0; i < count; ++i)
        result.emplace_back(texts[i].key, texts[i].text ? texts[i].text : "");
    return result;
}

}  // namespace

std::vector<std::uint8_t> encodePng(const Image& image, const PngText& text)
{
    SCREE_CHECK(image.width > 0 && image.height > 0, "a PNG file cannot hold an empty image");
    const std::vector<std::uint8_t> data =
        compressed(filteredRows(toSrgbBytes(image), static_cast<std::size_t>(image.width) * 3));
    std::vector<png_text> texts = pngTexts(text);
    std::vector<std::uint8_t> bytes;
    PngEncoder encoder;
    if (!encode(encoder, image.width, image.height, data, texts, bytes))
        throw Error(ErrorKind::internal, "libpng: " + encoder.error);
    return bytes;
}

PngContents decodePng(std::span<const std::uint8_t> bytes, const std::string& name)
{
    PngDecoder decoder(bytes);
    const std::vector<std::uint8_t> pixels = decode(decoder, name);
    const int width = static_cast<int>(png_get_image_width(decoder.png, decoder.info));
    const int height = static_cast<int>(png_get_image_height(decoder.png, decoder.info));
    return {fromSrgbBytes(width, height, pixels), textsOf(decoder)};
}

void requireWholePng(std::span<const std::uint8_t> bytes, const std::string& name)
{
    PngDecoder decoder(bytes);
    decode(decoder, name);
}

}  // namespace scree
