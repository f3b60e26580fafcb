class Stribeck < Formula
  desc "Explicit dynamics of rolling element bearings"
  homepage "{{repository}}"
  version "{{version}}"
  license any_of: ["MIT", "Apache-2.0"]

  on_linux do
    on_intel do
      url "{{repository}}/releases/download/v{{version}}/stribeck-{{version}}-x86_64-unknown-linux-gnu.tar.gz"
      sha256 "{{stribeck-{{version}}-x86_64-unknown-linux-gnu.tar.gz}}"
    end
    on_arm do
      url "{{repository}}/releases/download/v{{version}}/stribeck-{{version}}-aarch64-unknown-linux-gnu.tar.gz"
      sha256 "{{stribeck-{{version}}-aarch64-unknown-linux-gnu.tar.gz}}"
    end
  end

  def install
    bin.install "stribeck"
  end

  test do
    system bin/"stribeck", "demo"
  end
end
