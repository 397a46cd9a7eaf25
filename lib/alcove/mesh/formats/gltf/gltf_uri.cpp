#include "alcove/mesh/formats/gltf/gltf_uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace alcove {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::int8_t, 256> values_of_digits() {
    std::array<std::int8_t, 256> values{};
    values.fill(-1);
    for (std::size_t i = 0; i < digits.size(); ++i)
        values[static_cast<unsigned char>(digits[i])] = static_cast<std::int8_t>(i);
    return values;
}
constexpr std::array<std::int8_t, 256> digit_values = values_of_digits();

std::optional<std::string> decode_base64(std::string_view text) {
    while (text.ends_with('='))
        text.remove_suffix(1);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const std::int8_t value = digit_values[static_cast<unsigned char>(c)];
        if (value < 0)
            return {};
        bits = bits << 6 | static_cast<std::uint32_t>(value);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes.push_back(static_cast<char>(bits >> count & 0xff));
        }
    }
    return bytes;
}

std::optional<int> hexadecimal(char c) {
    constexpr std::string_view lower = "0123456789abcdef", upper = "0123456789ABCDEF";
    const std::size_t value = std::min(lower.find(c), upper.find(c));
    return value == std::string_view::npos ? std::nullopt : std::optional(static_cast<int>(value));
}

std::string percent_decoded(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool escaped = uri[i] == '%' && i + 2 < uri.size();
        const std::optional<int> high = escaped ? hexadecimal(uri[i + 1]) : std::nullopt;
        const std::optional<int> low = escaped ? hexadecimal(uri[i + 2]) : std::nullopt;
        text.push_back(high && low ? static_cast<char>(16 * *high + *low) : uri[i]);
        if (high && low)
            i += 2;
    }
    return text;
}

}

bool is_data_uri(std::string_view uri) {
    return uri.starts_with("data:");
}

std::optional<std::string> data_of_uri(std::string_view uri) {
    constexpr std::string_view encoding = ";base64,";
    const std::size_t at = uri.find(encoding);
    if (at == std::string_view::npos)
        return {};
    return decode_base64(uri.substr(at + encoding.size()));
}

std::string data_uri(std::string_view media_type, std::string_view first, std::string_view second) {
    std::string uri = fmt::format("data:{};base64,", media_type);
    const std::size_t size = first.size() + second.size();
    uri.reserve(uri.size() + (size + 2) / 3 * 4);
    const auto byte = [&](std::size_t i) {
        return i >= size ? 0u : static_cast<unsigned char>(i < first.size() ? first[i] : second[i - first.size()]);
    };
    for (std::size_t i = 0; i < size; i += 3) {
        const std::uint32_t bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
        for (std::size_t k = 0; k < 4; ++k)
            uri.push_back(i + k > size ? '=' : digits[bits >> (18 - 6 * k) & 63]);
    }
    return uri;
}

std::optional<std::filesystem::path> path_of_uri(std::string_view uri) {
    const std::string text = percent_decoded(uri);
    if (text.empty() || text.find_first_of(std::string_view("\\:\0", 3)) != std::string::npos)
        return {};
    std::filesystem::path path = std::filesystem::path(text).lexically_normal();
    if (path.is_absolute() || *path.begin() == "..")
        return {};
    return path;
}

std::string uri_of_path(const std::filesystem::path& path) {
    constexpr std::string_view unescaped = "/-._~!$&'()*+,;=@";
    std::string uri;
    for (const char c : path.generic_string())
        if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
            unescaped.find(c) != std::string_view::npos || static_cast<unsigned char>(c) >= 0x80)
            uri.push_back(c);
        else
            uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    return uri;
}

}
