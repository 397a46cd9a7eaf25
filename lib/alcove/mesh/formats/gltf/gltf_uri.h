/// The URIs of a glTF file: data in base64 (RFC 2397, RFC 4648) and files beside it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

bool is_data_uri(std::string_view uri);
/// The bytes of a data URI in base64; empty if the URI is damaged.
std::optional<std::string> data_of_uri(std::string_view uri);
std::string data_uri(std::string_view media_type, std::string_view first, std::string_view second = {});

/// The path of a relative URI, with %XX decoded; empty if the URI has a scheme, is absolute, or leads out of the
/// folder.
std::optional<std::filesystem::path> path_of_uri(std::string_view uri);
std::string uri_of_path(const std::filesystem::path& path);

}
