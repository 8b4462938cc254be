#include "io/live/dds_bytes.h"

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstring>

namespace rubble {
namespace {

// Both are handed around as pointers to their C base, which stands first; Cyclone counts references.
struct Sample : ddsi_serdata {
  std::string bytes;     // padded with zeros to a multiple of 4, as the protocol sends them
  std::size_t size = 0;  // without the padding
};
struct Type : ddsi_sertype {};

const std::string& bytes_of(const ddsi_serdata* data) {
  return static_cast<const Sample*>(data)->bytes;
}

Sample* new_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, std::string bytes) {
  auto* sample = new Sample;
  ddsi_serdata_init(sample, type, kind);
  sample->hash = type->serdata_basehash;  // no key: all are of one instance
  sample->size = bytes.size();
  bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
  sample->bytes = std::move(bytes);
  return sample;
}

std::uint32_t get_size(const ddsi_serdata* data) {
  return std::uint32_t(static_cast<const Sample*>(data)->size);
}

ddsi_serdata* from_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
  // Disposing of an instance asks for its key: there is none.
  if (kind == SDK_KEY) return new_sample(type, kind, std::string("\0\1\0\0", 4));
  return new_sample(type, kind, std::string(*static_cast<const DdsBytes*>(sample)));
}

ddsi_serdata* from_iov(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                       const ddsrt_iovec_t* parts, size_t size) {
  std::string bytes;
  for (ddsrt_msg_iovlen_t i = 0; i < count; ++i)
    bytes.append(static_cast<const char*>(parts[i].iov_base), parts[i].iov_len);
  bytes.resize(size);
  return new_sample(type, kind, std::move(bytes));
}

// In fragments, in order, which may overlap.
ddsi_serdata* from_network(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* part,
                           size_t size) {
  std::string bytes;
  for (; part; part = part->nextfrag) {
    if (part->maxp1 <= bytes.size()) continue;
    const auto* payload = reinterpret_cast<const char*>(
        NN_RMSG_PAYLOADOFF(part->rmsg, NN_RDATA_PAYLOAD_OFF(part)));
    const std::size_t known = bytes.size() - part->min;
    bytes.append(payload + known, part->maxp1 - bytes.size());
  }
  bytes.resize(size);
  return new_sample(type, kind, std::move(bytes));
}

ddsi_serdata* from_keyhash(const ddsi_sertype* type, const ddsi_keyhash*) {
  return new_sample(type, SDK_KEY, std::string("\0\1\0\0", 4));
}

void copy_out(const ddsi_serdata* data, size_t offset, size_t size, void* to) {
  std::memcpy(to, bytes_of(data).data() + offset, size);
}

ddsi_serdata* lend(const ddsi_serdata* data, size_t offset, size_t size, ddsrt_iovec_t* to) {
  to->iov_base = const_cast<char*>(bytes_of(data).data()) + offset;  // nobody writes to it
  to->iov_len = size;
  return ddsi_serdata_ref(data);
}

void take_back(ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); }

ddsi_serdata* to_untyped(const ddsi_serdata* data) {
  Sample* sample = new_sample(data->type, SDK_KEY, std::string("\0\1\0\0", 4));
  sample->type = nullptr;
  return sample;
}

bool to_sample(const ddsi_serdata* data, void* sample, void**, void*) {
  *static_cast<std::string*>(sample) = bytes_of(data).substr(0, get_size(data));
  return true;
}
bool untyped_to_sample(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
  return true;
}
bool same_key(const ddsi_serdata*, const ddsi_serdata*) { return true; }
void free_sample(ddsi_serdata* data) { delete static_cast<Sample*>(data); }

size_t print(const ddsi_sertype*, const ddsi_serdata*, char* to, size_t size) {
  if (size > 0) *to = '\0';
  return 0;
}

void get_keyhash(const ddsi_serdata*, ddsi_keyhash* to, bool) { std::memset(to, 0, sizeof *to); }

ddsi_serdata_ops make_sample_operations() {
  ddsi_serdata_ops operations{};
  operations.eqkey = same_key;
  operations.get_size = get_size;
  operations.from_ser = from_network;
  operations.from_ser_iov = from_iov;
  operations.from_keyhash = from_keyhash;
  operations.from_sample = from_sample;
  operations.to_ser = copy_out;
  operations.to_ser_ref = lend;
  operations.to_ser_unref = take_back;
  operations.to_sample = to_sample;
  operations.to_untyped = to_untyped;
  operations.untyped_to_sample = untyped_to_sample;
  operations.free = free_sample;
  operations.print = print;
  operations.get_keyhash = get_keyhash;
  return operations;
}

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete static_cast<Type*>(type);
}

void no_samples(const ddsi_sertype*, void*, size_t) {}
void no_lent_samples(const ddsi_sertype*, void**, size_t, dds_free_op_t) {}
void no_new_samples(void** samples, const ddsi_sertype*, void*, size_t, size_t count) {
  std::fill(samples, samples + count, nullptr);
}
bool same_type(const ddsi_sertype*, const ddsi_sertype*) { return true; }  // the names are the same
std::uint32_t hash_type(const ddsi_sertype*) { return 0; }

ddsi_sertype_ops make_type_operations() {
  ddsi_sertype_ops operations{};
  operations.version = ddsi_sertype_v0;
  operations.free = free_type;
  operations.zero_samples = no_samples;
  operations.realloc_samples = no_new_samples;
  operations.free_samples = no_lent_samples;
  operations.equal = same_type;
  operations.hash = hash_type;
  return operations;
}

}  // namespace

dds_entity_t create_bytes_topic(dds_entity_t participant, const std::string& topic,
                                const std::string& type) {
  static const ddsi_serdata_ops sample_operations = make_sample_operations();
  static const ddsi_sertype_ops type_operations = make_type_operations();
  ddsi_sertype* made = new Type{};
  ddsi_sertype_init_flags(made, type.c_str(), &type_operations, &sample_operations,
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  made->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  const dds_entity_t entity =
      dds_create_topic_sertype(participant, topic.c_str(), &made, nullptr, nullptr, nullptr);
  if (entity < 0) ddsi_sertype_unref(made);
  return entity;
}

std::vector<std::string> take_bytes(dds_entity_t reader, std::size_t most) {
  std::vector<std::string> all;
  for (DdsSample& sample : take_samples(reader, most)) all.push_back(std::move(sample.bytes));
  return all;
}

std::vector<DdsSample> take_samples(dds_entity_t reader, std::size_t most) {
  std::vector<DdsSample> all;
  std::string bytes;
  void* sample = &bytes;
  dds_sample_info_t info;
  for (std::size_t i = 0; i < most && dds_take(reader, &sample, &info, 1, 1) > 0; ++i)
    if (info.valid_data) all.push_back({std::move(bytes), info.publication_handle});
  return all;
}

}  // namespace rubble
