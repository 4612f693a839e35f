#include "support/dicom_writer.h"

#include <itkGDCMImageIO.h>
#include <itkImage.h>
#include <itkImageFileWriter.h>
#include <itkMetaDataObject.h>

namespace tissue_test {

void write_dicom_slice(const std::string& path, const std::string& series, int number, double z) {
  using Slice = itk::Image<short, 3>;
  auto image = Slice::New();
  image->SetRegions(Slice::SizeType{{6, 5, 1}});
  image->Allocate();
  const double spacing[3] = {0.5, 0.7, 1.0};
  image->SetSpacing(spacing);
  const double origin[3] = {-10.0, 20.0, z};
  image->SetOrigin(origin);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x) {
      image->SetPixel({{x, y, 0}}, static_cast<short>(10.0 * z + x));
    }
  }
  auto io = itk::GDCMImageIO::New();
  io->KeepOriginalUIDOn();
  itk::MetaDataDictionary& tags = io->GetMetaDataDictionary();
  const auto set = [&](const char* tag, const std::string& value) {
    itk::EncapsulateMetaData<std::string>(tags, tag, value);
  };
  set("0008|0060", "CT");
  set("0008|0016", "1.2.840.10008.5.1.4.1.1.2");
  set("0020|000d", "1.2.826.0.1.3680043.2.1125.1");
  set("0020|000e", series);
  set("0008|0018", series + "." + std::to_string(number));
  set("0020|0052", "1.2.826.0.1.3680043.2.1125.2");
  set("0020|0013", std::to_string(number));
  set("0020|0032", "-10\\20\\" + std::to_string(z));
  set("0020|0037", "1\\0\\0\\0\\1\\0");
  set("0018|0050", "1");
  auto writer = itk::ImageFileWriter<Slice>::New();
  writer->SetInput(image);
  writer->SetFileName(path);
  writer->SetImageIO(io);
  writer->UseInputMetaDataDictionaryOff();
  writer->Update();
}

}  // namespace tissue_test
