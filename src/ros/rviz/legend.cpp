#include "ros/rviz/legend.h"

#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>
#include <Overlay/OgreOverlay.h>
#include <Overlay/OgreOverlayContainer.h>
#include <Overlay/OgreOverlayManager.h>
#include <Overlay/OgrePanelOverlayElement.h>
#include <QFontMetrics>
#include <QImage>
#include <QPainter>

#include <algorithm>

namespace tissue_ros {
namespace {

constexpr int kRow = 20, kMargin = 8;

QImage painted(const std::string& title, const std::vector<Legend::Line>& lines) {
  const QFont font("sans", 10);
  const QFontMetrics metrics(font);
  int width = metrics.boundingRect(QString::fromStdString(title)).width();
  for (const Legend::Line& line : lines) {
    width = std::max(width, kRow + metrics.boundingRect(QString::fromStdString(line.text)).width());
  }
  QImage image(width + 3 * kMargin, kRow * static_cast<int>(lines.size() + 1) + 2 * kMargin,
               QImage::Format_ARGB32);
  image.fill(QColor(255, 255, 255, 200));
  QPainter painter(&image);
  painter.setFont(font);
  int top = kMargin;
  painter.drawText(kMargin, top, image.width(), kRow, Qt::AlignVCenter,
                   QString::fromStdString(title));
  for (const Legend::Line& line : lines) {
    top += kRow;
    const auto part = [](float share) { return static_cast<int>(255.0f * share); };
    painter.fillRect(kMargin, top + 3, kRow - 6, kRow - 6,
                     QColor(part(line.colour[0]), part(line.colour[1]), part(line.colour[2])));
    painter.drawText(kMargin + kRow, top, image.width(), kRow, Qt::AlignVCenter,
                     QString::fromStdString(line.text));
  }
  return image;
}

}  // namespace

Legend::Legend(const std::string& name) : name_(name) {
  auto& overlays = Ogre::OverlayManager::getSingleton();
  overlay_ = overlays.create(name);
  panel_ = static_cast<Ogre::PanelOverlayElement*>(
      overlays.createOverlayElement("Panel", name + "Panel"));
  panel_->setMetricsMode(Ogre::GMM_PIXELS);
  panel_->setVerticalAlignment(Ogre::GVA_BOTTOM);
  material_ = Ogre::MaterialManager::getSingleton().create(
      name, Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
  Ogre::Pass* const pass = material_->getTechnique(0)->getPass(0);
  pass->setLightingEnabled(false);
  pass->setDepthCheckEnabled(false);
  pass->setDepthWriteEnabled(false);
  pass->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
  panel_->setMaterialName(name);
  overlay_->add2D(panel_);
}

Legend::~Legend() {
  auto& overlays = Ogre::OverlayManager::getSingleton();
  overlay_->remove2D(panel_);
  overlays.destroyOverlayElement(panel_);
  overlays.destroy(overlay_);
  Ogre::MaterialManager::getSingleton().remove(material_->getHandle());
  forget_texture();
}

void Legend::forget_texture() {
  if (texture_.get() != nullptr) Ogre::TextureManager::getSingleton().remove(texture_->getHandle());
}

void Legend::show(const std::string& title, const std::vector<Line>& lines) {
  const QImage image = painted(title, lines);
  const auto width = static_cast<Ogre::uint32>(image.width()),
             height = static_cast<Ogre::uint32>(image.height());
  forget_texture();
  texture_ = Ogre::TextureManager::getSingleton().createManual(
      name_, Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME, Ogre::TEX_TYPE_2D, width,
      height, 0, Ogre::PF_A8R8G8B8, Ogre::TU_DEFAULT);
  texture_->getBuffer()->blitFromMemory(
      Ogre::PixelBox(width, height, 1, Ogre::PF_A8R8G8B8, const_cast<uchar*>(image.constBits())));
  Ogre::Pass* const pass = material_->getTechnique(0)->getPass(0);
  pass->removeAllTextureUnitStates();
  pass->createTextureUnitState(name_)->setTextureFiltering(Ogre::TFO_NONE);
  panel_->setDimensions(static_cast<float>(width), static_cast<float>(height));
  panel_->setPosition(10.0f, -10.0f - static_cast<float>(height));
  overlay_->show();
}

void Legend::hide() { overlay_->hide(); }

}  // namespace tissue_ros
