// HDF5 files in memory through the C API: every handle closed, every return code checked.
#include "checkpoint/hdf5_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <type_traits>
#include <utility>

#include "base/error.hpp"

namespace bedload {
namespace {

constexpr std::size_t image_growth = std::size_t(1) << 20;   // bytes by which the image in memory grows
constexpr std::uint64_t chunk_bytes = std::uint64_t(16) << 20;

static_assert(std::is_same_v<hid_t, std::int64_t>, "the header keeps handles as std::int64_t");

/// The first, innermost complaint on HDF5's error stack; HDF5 itself prints nothing.
std::string innermost_complaint() {
  std::string complaint = "no reason given";
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned place, const H5E_error2_t* entry, void* text) -> herr_t {
        if (place == 0) *static_cast<std::string*>(text) = entry->desc;
        return 0;
      },
      &complaint);
  return complaint;
}

void silence_hdf5() {
  static const herr_t once = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  if (once < 0) throw Error(ErrorKind::internal, "HDF5 does not start");
}

/// A handle that is closed by the function that belongs to its kind.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
  hid_t release() { return std::exchange(id_, -1); }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

template <class Number>
struct NumberType;
template <>
struct NumberType<double> {
  static hid_t in_file() { return H5T_IEEE_F64LE; }
  static hid_t in_memory() { return H5T_NATIVE_DOUBLE; }
};
template <>
struct NumberType<std::uint64_t> {
  static hid_t in_file() { return H5T_STD_U64LE; }
  static hid_t in_memory() { return H5T_NATIVE_UINT64; }
};
template <>
struct NumberType<std::int64_t> {
  static hid_t in_file() { return H5T_STD_I64LE; }
  static hid_t in_memory() { return H5T_NATIVE_INT64; }
};
template <>
struct NumberType<std::uint32_t> {
  static hid_t in_file() { return H5T_STD_U32LE; }
  static hid_t in_memory() { return H5T_NATIVE_UINT32; }
};
template <>
struct NumberType<std::uint8_t> {
  static hid_t in_file() { return H5T_STD_U8LE; }
  static hid_t in_memory() { return H5T_NATIVE_UINT8; }
};

std::uint64_t product(std::span<const std::uint64_t> shape) {
  return std::accumulate(shape.begin(), shape.end(), std::uint64_t(1), std::multiplies<>());
}

// --- writing: a failure is a fault of ours (or memory has run out), never the user's file

template <class Id>
Id made(Id id, const std::string& what) {
  if (id < 0) throw Error(ErrorKind::internal, fmt::format("HDF5 cannot make {}: {}", what, innermost_complaint()));
  return id;
}

Handle file_access_in_memory() {
  Handle access(made(H5Pcreate(H5P_FILE_ACCESS), "a file access list"), H5Pclose);
  made(H5Pset_fapl_core(access, image_growth, false), "a file in memory");
  // The oldest file format, HDF5's default: H5Fget_file_image of 1.10 spoils the superblock checksum of the newer ones.
  return access;
}

/// Creation properties without object times, which would stamp the hour into the bytes.
Handle timeless(hid_t kind) {
  Handle properties(made(H5Pcreate(kind), "creation properties"), H5Pclose);
  made(H5Pset_obj_track_times(properties, false), "an object without times");
  return properties;
}

Handle space_of(std::span<const std::uint64_t> shape) {
  if (shape.empty()) return Handle(made(H5Screate(H5S_SCALAR), "a scalar space"), H5Sclose);
  const std::vector<hsize_t> extents(shape.begin(), shape.end());
  return Handle(made(H5Screate_simple(int(extents.size()), extents.data(), nullptr), "a space"), H5Sclose);
}

/// Arrays in equal chunks along the slowest extent with Fletcher32; single numbers inside their header; empty arrays
/// have no bytes and so no chunks.
Handle dataset_layout(std::span<const std::uint64_t> shape, std::size_t number_bytes) {
  Handle layout = timeless(H5P_DATASET_CREATE);
  if (shape.empty()) made(H5Pset_layout(layout, H5D_COMPACT), "a compact layout");
  if (shape.empty() || product(shape) == 0) return layout;
  std::vector<hsize_t> chunk(shape.begin(), shape.end());
  const std::uint64_t pieces = std::min(shape[0], 1 + product(shape) * number_bytes / chunk_bytes);
  chunk[0] = (shape[0] + pieces - 1) / pieces;
  made(H5Pset_chunk(layout, int(chunk.size()), chunk.data()), "chunks");
  made(H5Pset_fletcher32(layout), "checksums");
  return layout;
}

/// An index node has room for 2 x 32 chunks by default; nearly all our arrays are one chunk, and the room would be most
/// of a small file.
Handle file_with_small_indices() {
  Handle creation = timeless(H5P_FILE_CREATE);
  made(H5Pset_istore_k(creation, 2), "a file with small chunk indices");
  return creation;
}

/// Makes the groups on the way to a data set.
void make_groups(hid_t file, const std::string& path) {
  for (auto slash = path.find('/'); slash != std::string::npos; slash = path.find('/', slash + 1)) {
    const std::string group = path.substr(0, slash);
    if (made(H5Lexists(file, group.c_str(), H5P_DEFAULT), group) > 0) continue;
    const Handle properties = timeless(H5P_GROUP_CREATE);
    Handle(made(H5Gcreate2(file, group.c_str(), H5P_DEFAULT, properties, H5P_DEFAULT), group), H5Gclose);
  }
}

void write_text(hid_t object, const char* name, const std::string& text) {
  const Handle type(made(H5Tcopy(H5T_C_S1), "a string type"), H5Tclose);
  made(H5Tset_size(type, text.size()), "a string type");
  const Handle space = space_of({});
  const Handle attribute(made(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), name), H5Aclose);
  made(H5Awrite(attribute, type, text.data()), name);
}

// --- reading: a failure is the file's fault

[[noreturn]] void refuse(const std::string& file, const std::string& fact) {
  throw Error(ErrorKind::corrupt, fmt::format("{}: {}", file, fact));
}

template <class Id>
Id found(Id id, const std::string& file, const std::string& what) {
  if (id < 0) refuse(file, fmt::format("cannot read {}: {}", what, innermost_complaint()));
  return id;
}

/// H5Lexists wants every group on the way to exist before it is asked about the next.
void require_path(hid_t file, const std::string& name, const std::string& path) {
  for (std::size_t slash = 0; slash != std::string::npos;) {
    slash = path.find('/', slash + 1);
    if (H5Lexists(file, path.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) refuse(name, "there is no " + path);
  }
}

Handle open_dataset(hid_t file, const std::string& name, const std::string& path) {
  require_path(file, name, path);
  return Handle(found(H5Dopen2(file, path.c_str(), H5P_DEFAULT), name, path), H5Dclose);
}

Shape shape_of(hid_t dataset, const std::string& name, const std::string& path) {
  const Handle space(found(H5Dget_space(dataset), name, path), H5Sclose);
  std::vector<hsize_t> extents(found(H5Sget_simple_extent_ndims(space), name, path));
  found(H5Sget_simple_extent_dims(space, extents.data(), nullptr), name, path);
  return {extents.begin(), extents.end()};
}

}   // namespace

// --- Hdf5Writer

Hdf5Writer::Hdf5Writer() {
  silence_hdf5();
  // HDF5 takes two files in memory of one name for the same file, so the name is this object's own.
  const std::string name = fmt::format("in memory, written by {}", static_cast<const void*>(this));
  const Handle access = file_access_in_memory(), creation = file_with_small_indices();
  file_ = made(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, creation, access), "a file in memory");
}

Hdf5Writer::~Hdf5Writer() { H5Fclose(file_); }

template <class Number>
void Hdf5Writer::write(const std::string& path, std::span<const Number> numbers, std::span<const std::uint64_t> shape,
                       const std::string& unit) {
  if (numbers.size() != product(shape))
    throw Error(ErrorKind::internal,
                fmt::format("{}: {} numbers for a shape of {}", path, numbers.size(), product(shape)));
  make_groups(file_, path);
  const Handle space = space_of(shape), layout = dataset_layout(shape, sizeof(Number));
  const hid_t type = NumberType<Number>::in_file();
  const Handle dataset(made(H5Dcreate2(file_, path.c_str(), type, space, H5P_DEFAULT, layout, H5P_DEFAULT), path),
                       H5Dclose);
  if (!numbers.empty())
    made(H5Dwrite(dataset, NumberType<Number>::in_memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), path);
  write_text(dataset, "unit", unit);
}

void Hdf5Writer::write_attribute(const std::string& name, std::uint64_t value) {
  const Handle space = space_of({});
  const Handle attribute(made(H5Acreate2(file_, name.c_str(), H5T_STD_U64LE, space, H5P_DEFAULT, H5P_DEFAULT), name),
                         H5Aclose);
  made(H5Awrite(attribute, H5T_NATIVE_UINT64, &value), name);
}

template <class Number>
void Hdf5Writer::write_attribute(const std::string& group, const std::string& name, std::span<const Number> numbers) {
  make_groups(file_, group + "/");
  const Handle object(made(H5Gopen2(file_, group.c_str(), H5P_DEFAULT), group), H5Gclose);
  const Handle space = space_of(Shape{numbers.size()});
  const hid_t type = NumberType<Number>::in_file();
  const Handle attribute(made(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), name), H5Aclose);
  made(H5Awrite(attribute, NumberType<Number>::in_memory(), numbers.data()), name);
}
template void Hdf5Writer::write_attribute(const std::string&, const std::string&, std::span<const double>);
template void Hdf5Writer::write_attribute(const std::string&, const std::string&, std::span<const std::int64_t>);

void Hdf5Writer::write_attribute(const std::string& group, const std::string& name, const std::string& text) {
  make_groups(file_, group + "/");
  const Handle object(made(H5Gopen2(file_, group.c_str(), H5P_DEFAULT), group), H5Gclose);
  write_text(object, name.c_str(), text);
}

std::vector<std::byte> Hdf5Writer::image() {
  made(H5Fflush(file_, H5F_SCOPE_LOCAL), "an image");
  std::vector<std::byte> bytes(std::size_t(made(H5Fget_file_image(file_, nullptr, 0), "an image")));
  made(H5Fget_file_image(file_, bytes.data(), bytes.size()), "an image");
  return bytes;
}

// --- Hdf5Reader

Hdf5Reader::Hdf5Reader(std::span<const std::byte> image, std::string name) : name_(std::move(name)) {
  silence_hdf5();
  const std::string own_name = fmt::format("in memory, read by {}", static_cast<const void*>(this));
  const Handle access = file_access_in_memory();
  void* bytes = const_cast<std::byte*>(image.data());   // copied, never written: HDF5's signature lacks the const
  made(H5Pset_file_image(access, bytes, image.size()), "a copy of an image");
  file_ = found(H5Fopen(own_name.c_str(), H5F_ACC_RDONLY, access), name_, "it as HDF5");
}

Hdf5Reader::~Hdf5Reader() { H5Fclose(file_); }

Shape Hdf5Reader::shape(const std::string& path) const {
  return shape_of(open_dataset(file_, name_, path), name_, path);
}

std::string Hdf5Reader::unit(const std::string& path) const {
  const Handle dataset = open_dataset(file_, name_, path);
  const Handle attribute(found(H5Aopen(dataset, "unit", H5P_DEFAULT), name_, "the unit of " + path), H5Aclose);
  const Handle type(found(H5Aget_type(attribute), name_, "the unit of " + path), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0)
    refuse(name_, path + " has a unit that is no text");
  std::string unit(H5Tget_size(type), '\0');
  found(H5Aread(attribute, type, unit.data()), name_, "the unit of " + path);
  return unit;
}

std::uint64_t Hdf5Reader::attribute(const std::string& name) const {
  const Handle attribute(found(H5Aopen(file_, name.c_str(), H5P_DEFAULT), name_, "attribute " + name), H5Aclose);
  const Handle space(found(H5Aget_space(attribute), name_, "attribute " + name), H5Sclose);
  if (H5Sget_simple_extent_npoints(space) != 1) refuse(name_, fmt::format("attribute {} is not one number", name));
  std::uint64_t value = 0;
  found(H5Aread(attribute, H5T_NATIVE_UINT64, &value), name_, "attribute " + name);
  return value;
}

template <class Number>
void Hdf5Reader::read(const std::string& path, std::span<Number> numbers) const {
  const Handle dataset = open_dataset(file_, name_, path);
  const Handle type(found(H5Dget_type(dataset), name_, path), H5Tclose);
  if (H5Tequal(type, NumberType<Number>::in_file()) <= 0) refuse(name_, path + " holds numbers of another type");
  const std::uint64_t stored = product(shape_of(dataset, name_, path));
  if (stored != numbers.size()) refuse(name_, fmt::format("{} holds {} numbers, not {}", path, stored, numbers.size()));
  if (numbers.empty()) return;
  found(H5Dread(dataset, NumberType<Number>::in_memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), name_, path);
}

#define BEDLOAD_NUMBER(Number)                                                                                 \
  template void Hdf5Writer::write(const std::string&, std::span<const Number>, std::span<const std::uint64_t>, \
                                  const std::string&);                                                         \
  template void Hdf5Reader::read(const std::string&, std::span<Number>) const;
BEDLOAD_NUMBER(double)
BEDLOAD_NUMBER(std::uint64_t)
BEDLOAD_NUMBER(std::int64_t)
BEDLOAD_NUMBER(std::uint32_t)
BEDLOAD_NUMBER(std::uint8_t)
#undef BEDLOAD_NUMBER

}   // namespace bedload
