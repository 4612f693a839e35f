#include "itk_bridge.h"

#include "tissue/base/error.h"

#include <itkBinaryBallStructuringElement.h>
#include <itkBinaryMorphologicalOpeningImageFilter.h>
#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkImageFileReader.h>
#include <itkImageIOFactory.h>
#include <itkImageSeriesReader.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>
#include <itkSmoothingRecursiveGaussianImageFilter.h>
#include <itksys/SystemTools.hxx>

#include <algorithm>
#include <cmath>

namespace tissue {
namespace {

using MaskImage = itk::Image<std::uint8_t, 3>;
using FloatImage = itk::Image<float, 3>;

template <class Image, class T>
typename Image::Pointer image_of(const GridSize& size, const std::array<double, 3>& spacing,
                                 const std::vector<T>& values) {
  auto image = Image::New();
  typename Image::SizeType image_size;
  for (unsigned int axis = 0; axis < 3; ++axis) image_size[axis] = size[axis];
  image->SetRegions(image_size);
  image->SetSpacing(spacing.data());
  image->Allocate();
  std::copy(values.begin(), values.end(), image->GetBufferPointer());
  return image;
}

template <class Image>
std::vector<typename Image::PixelType> voxels_of(const Image& image) {
  const auto* begin = image.GetBufferPointer();
  return {begin, begin + image.GetBufferedRegion().GetNumberOfPixels()};
}

// The slices of the one series in a folder, in their order.
std::vector<std::string> slices_in(const std::string& folder) {
  auto names = itk::GDCMSeriesFileNames::New();
  names->SetUseSeriesDetails(true);
  names->SetDirectory(folder);
  const std::vector<std::string>& series = names->GetSeriesUIDs();
  if (series.empty()) {
    throw InputError(ErrorCode::kFile, "volume: '" + folder + "' holds no DICOM series");
  }
  if (series.size() > 1) {
    std::string list;
    for (const std::string& uid : series) {
      list += "\n  " + uid + " (" + std::to_string(names->GetFileNames(uid).size()) + " files)";
    }
    throw InputError(ErrorCode::kFile, "volume: '" + folder + "' holds " +
                                           std::to_string(series.size()) +
                                           " DICOM series; keep one of them in a folder:" + list);
  }
  return names->GetFileNames(series[0]);
}

// A volume has one distance between slices: a gap or a skipped slice would be closed silently.
void require_even_slices(const std::vector<std::string>& slices) {
  std::vector<std::array<double, 3>> origins;
  for (const std::string& slice : slices) {
    auto io = itk::GDCMImageIO::New();
    io->SetFileName(slice);
    io->ReadImageInformation();
    origins.push_back({io->GetOrigin(0), io->GetOrigin(1), io->GetOrigin(2)});
  }
  const auto gap = [&](std::size_t i) {
    double squared = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      squared += std::pow(origins[i + 1][axis] - origins[i][axis], 2);
    }
    return std::sqrt(squared);
  };
  for (std::size_t i = 1; i + 1 < origins.size(); ++i) {
    if (std::abs(gap(i) - gap(0)) <= 0.01 * gap(0)) continue;
    throw InputError(ErrorCode::kNonuniform, "volume: slices are " + to_text(gap(0)) + " mm and " +
                                                 to_text(gap(i)) + " mm apart, the latter from '" +
                                                 slices[i] + "' on");
  }
}

bool is_folder(const std::string& path) { return itksys::SystemTools::FileIsDirectory(path); }

itk::ImageIOBase::Pointer open_image(const std::string& given) {
  const std::string path = is_folder(given) ? slices_in(given).front() : given;
  auto io = itk::ImageIOFactory::CreateImageIO(path.c_str(), itk::ImageIOFactory::ReadMode);
  if (io == nullptr) {
    throw InputError(ErrorCode::kFile,
                     "volume: '" + path + "' cannot be read as NIfTI, NRRD or MetaImage");
  }
  io->SetFileName(path);
  io->ReadImageInformation();
  if (io->GetNumberOfComponents() != 1) {
    throw InputError(ErrorCode::kEncoding, "volume: '" + path + "' has " +
                                               std::to_string(io->GetNumberOfComponents()) +
                                               " values per voxel, not 1");
  }
  for (unsigned int axis = 3; axis < io->GetNumberOfDimensions(); ++axis) {
    if (io->GetDimensions(axis) == 1) continue;
    throw InputError(ErrorCode::kDims, "volume: '" + path + "' has more than three dimensions");
  }
  return io;
}

template <class Image>
typename Image::Pointer load(const std::string& path) {
  if (is_folder(path)) {
    auto reader = itk::ImageSeriesReader<Image>::New();
    reader->SetImageIO(itk::GDCMImageIO::New());
    reader->SetFileNames(slices_in(path));
    reader->Update();
    return reader->GetOutput();
  }
  auto reader = itk::ImageFileReader<Image>::New();
  reader->SetFileName(path);
  reader->Update();
  return reader->GetOutput();
}

template <class T>
ImageFile read_as(const std::string& path) {
  const auto loaded = load<itk::Image<T, 3>>(path);
  const itk::Image<T, 3>& image = *loaded;
  ImageFile file;
  for (unsigned int i = 0; i < 3; ++i) {
    file.size[i] = static_cast<std::uint32_t>(image.GetLargestPossibleRegion().GetSize()[i]);
    file.spacing[i] = image.GetSpacing()[i];
    file.origin[i] = image.GetOrigin()[i];
    for (unsigned int j = 0; j < 3; ++j) file.direction[i][j] = image.GetDirection()(i, j);
  }
  file.voxels = voxels_of(image);
  return file;
}

}  // namespace

ImageFile read_image(const std::string& path) {
  try {
    if (is_folder(path)) require_even_slices(slices_in(path));
    const itk::ImageIOBase::Pointer io = open_image(path);
    using Component = itk::ImageIOBase::IOComponentType;
    const Component type = io->GetComponentType();
    const std::size_t bytes = io->GetComponentSize();
    const bool is_float = type == itk::ImageIOBase::FLOAT || type == itk::ImageIOBase::DOUBLE;
    const bool is_signed = type == itk::ImageIOBase::CHAR || type == itk::ImageIOBase::SHORT ||
                           type == itk::ImageIOBase::INT;
    if (is_float) return bytes == 4 ? read_as<float>(path) : read_as<double>(path);
    if (is_signed) return bytes <= 2 ? read_as<std::int16_t>(path) : read_as<std::int32_t>(path);
    if (type == itk::ImageIOBase::UCHAR) return read_as<std::uint8_t>(path);
    if (type == itk::ImageIOBase::USHORT) return read_as<std::uint16_t>(path);
    return read_as<double>(path);
  } catch (const itk::ExceptionObject& exception) {
    throw InputError(ErrorCode::kFile,
                     "volume: '" + path + "' cannot be read: " + exception.GetDescription());
  }
}

std::vector<std::uint8_t> opened(const GridSize& size, const std::vector<std::uint8_t>& set,
                                 unsigned int radius) {
  using Ball = itk::BinaryBallStructuringElement<std::uint8_t, 3>;
  Ball ball;
  ball.SetRadius(radius);
  ball.CreateStructuringElement();
  auto filter = itk::BinaryMorphologicalOpeningImageFilter<MaskImage, MaskImage, Ball>::New();
  filter->SetInput(image_of<MaskImage>(size, {1.0, 1.0, 1.0}, set));
  filter->SetKernel(ball);
  filter->SetForegroundValue(1);
  filter->SetBackgroundValue(0);
  filter->Update();
  return voxels_of(*filter->GetOutput());
}

std::vector<float> blurred(const GridSize& size, const std::vector<std::uint8_t>& set,
                           double sigma) {
  auto filter = itk::SmoothingRecursiveGaussianImageFilter<FloatImage, FloatImage>::New();
  filter->SetInput(image_of<FloatImage>(size, {1.0, 1.0, 1.0}, set));
  filter->SetSigma(sigma);
  filter->Update();
  return voxels_of(*filter->GetOutput());
}

std::vector<float> distance_to_set(const GridSize& size, const std::array<double, 3>& spacing,
                                   const std::vector<std::uint8_t>& set) {
  auto filter = itk::SignedMaurerDistanceMapImageFilter<MaskImage, FloatImage>::New();
  filter->SetInput(image_of<MaskImage>(size, spacing, set));
  filter->SetUseImageSpacing(true);
  filter->SetSquaredDistance(false);
  filter->SetInsideIsPositive(false);
  filter->Update();
  return voxels_of(*filter->GetOutput());
}

}  // namespace tissue
