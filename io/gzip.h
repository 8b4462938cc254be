// One gzip member: compressed bytes that can be appended to others in one .gz file, which every
// reader takes for one stream. It holds no name and no time.
#pragma once

#include <string>
#include <string_view>

namespace rubble {

// level: 0 (stored) to 9. Throws RunError when zlib fails.
std::string make_gzip_member(std::string_view bytes, int level);

}  // namespace rubble
