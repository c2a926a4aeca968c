"""Videos: exact frames at exact times, upright, in bounded memory, and clear words about broken files."""

from __future__ import annotations

import pickle
import subprocess
import sys
import threading
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.formats import open_images, open_video, write_image, write_video, write_working_copy
from imitation.errors import Cancelled, InputError

BITS = 9


def numbered(number: int, height: int = 96, width: int = 176) -> np.ndarray:
    """A picture that shows its number as bars, with a red patch in the lower left corner."""
    picture = np.full((height, width, 3), 60, np.uint8)
    for bit in range(BITS):
        picture[8:40, 8 + 18 * bit : 22 + 18 * bit] = 235 * (number >> bit & 1)
    picture[60:90, 8:40] = (200, 30, 40)
    return picture


def number_of(picture: np.ndarray) -> int:
    """Read the number a picture shows."""
    return sum(int(picture[24, 15 + 18 * bit].mean() > 128) << bit for bit in range(BITS))


def write_uneven(path: Path, ticks: list[int], rotation: int = 0) -> None:
    """Write one numbered picture at each of the given times, in ticks of 1/600 s, with B-frames."""
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=600, options={"g": "30", "bf": "3"})
        stream.width, stream.height, stream.pix_fmt = 176, 96, "yuv420p"
        stream.codec_context.time_base = Fraction(1, 600)
        if rotation:
            stream.set_display_rotation(rotation)
        for number, tick in enumerate(ticks):
            frame = av.VideoFrame.from_ndarray(numbered(number), format="rgb24")
            frame.pts, frame.time_base = tick, Fraction(1, 600)
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))


@pytest.fixture(scope="module")
def clips(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the same 200 numbered frames at GOP 12 and at GOP 250."""
    folder = tmp_path_factory.mktemp("clips")
    for gop in (12, 250):
        write_video(folder / f"gop{gop}.mp4", [numbered(n) for n in range(200)], Fraction(30000, 1001), gop=gop)
    return folder


@pytest.mark.parametrize("gop", [12, 250])
@pytest.mark.parametrize("memory", [1 << 19, 64 << 20])
def test_any_order_gives_the_right_frames_in_bounded_memory(clips: Path, gop: int, memory: int) -> None:
    """Random, backward and forward access show the frame asked for, and no more memory is held than allowed."""
    order = [*np.random.default_rng(gop).integers(0, 200, 40), *range(150, 130, -1), *range(200), -1]
    with open_video(clips / f"gop{gop}.mp4", memory=memory) as video:
        assert len(video) == 200
        for frame in order:
            assert number_of(video[int(frame)]) == frame % 200
            assert video.memory_used <= memory


def test_rate_size_and_times_are_exact(clips: Path) -> None:
    """The NTSC rate survives as a fraction and the times are its multiples."""
    with open_video(clips / "gop12.mp4") as video:
        assert (video.fps, video.size, video.rotation) == (Fraction(30000, 1001), (176, 96), 0)
        np.testing.assert_allclose(video.times, np.arange(200) * 1001 / 30000, atol=1e-9)


@settings(deadline=None, max_examples=12)
@given(gaps=st.lists(st.integers(5, 200), min_size=1, max_size=60), seed=st.integers(0, 9))
def test_variable_rates_keep_their_times(tmp_path_factory: pytest.TempPathFactory, gaps: list[int], seed: int) -> None:
    """Each frame of an uneven video has its own exact time, and is found by random access."""
    ticks = [0, *np.cumsum(gaps).tolist()]
    path = tmp_path_factory.mktemp("uneven") / "clip.mp4"
    write_uneven(path, ticks)
    with open_video(path, memory=1 << 18) as video:
        np.testing.assert_allclose(video.times, np.array(ticks) / 600, atol=1e-6)
        for frame in np.random.default_rng(seed).permutation(len(ticks)):
            assert number_of(video[int(frame)]) == frame


@pytest.mark.parametrize(("rotation", "corner"), [(90, (1, 1)), (180, (0, 1)), (270, (0, 0)), (0, (1, 0))])
def test_rotated_videos_stand_upright(tmp_path: Path, rotation: int, corner: tuple[int, int]) -> None:
    """A rotation stated by the file (counter-clockwise) is applied: the red patch goes to the turned corner."""
    write_uneven(tmp_path / "clip.mp4", [0, 20, 40], rotation)
    with open_video(tmp_path / "clip.mp4") as video:
        picture = video[1].astype(int)
        assert video.size == picture.shape[1::-1] == ((96, 176) if rotation % 180 else (176, 96))
        red = np.argwhere(picture[..., 0] - picture[..., 1] > 100).mean(0) / picture.shape[:2]
        assert tuple((red > 0.5).astype(int)) == corner


def test_pictures_are_read_only_and_views_are_lazy(clips: Path) -> None:
    """Nobody can change a cached frame, and a slice gives the frames of the slice."""
    with open_video(clips / "gop12.mp4") as video:
        with pytest.raises(ValueError, match="read-only"):
            video[3][0, 0] = 0
        view = video[10:20:3]
        assert [number_of(picture) for picture in view] == [10, 13, 16, 19]
        assert number_of(view[-1]) == 19
        with pytest.raises(IndexError):
            video[200]


def test_sources_travel_to_other_processes(clips: Path, tmp_path: Path) -> None:
    """A pickled source opens the same medium again."""
    write_image(tmp_path / "1.png", numbered(1))
    for source in (open_video(clips / "gop12.mp4"), open_images(tmp_path, fps=30)):
        with source, pickle.loads(pickle.dumps(source)) as again:
            assert (again.fingerprint, again.fps, len(again)) == (source.fingerprint, source.fps, len(source))
            np.testing.assert_array_equal(again[-1], source[-1])


def test_a_closed_video_says_so(clips: Path) -> None:
    """Frames of a closed video cannot be read."""
    with open_video(clips / "gop12.mp4") as video:
        pass
    with pytest.raises(InputError, match="is closed"):
        video[3]


def test_threads_share_one_video(clips: Path) -> None:
    """Frames asked for by four threads at once are all right."""
    wrong: list[int] = []
    with open_video(clips / "gop12.mp4", memory=1 << 20) as video:

        def read(seed: int) -> None:
            order = np.random.default_rng(seed).integers(0, 200, 25).tolist()
            wrong.extend(frame for frame in order if number_of(video[frame]) != frame)

        threads = [threading.Thread(target=read, args=(seed,)) for seed in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert not wrong


def test_odd_sizes_are_filled_up(tmp_path: Path) -> None:
    """H.264 has no odd sizes: the last row and column are repeated, the rest stays."""
    picture = numbered(5, 97, 177)
    write_video(tmp_path / "clip.mp4", [picture] * 3, 25)
    with open_video(tmp_path / "clip.mp4") as video:
        assert video.size == (178, 98)
        assert np.abs(video[2][:97, :177].astype(int) - picture).mean() < 2
        assert np.abs(video[2][97, :177].astype(int) - picture[96]).mean() < 2


def test_colours_survive(tmp_path: Path) -> None:
    """Flat colours come back within two levels through the BT.709 conversion."""
    for colour in [(200, 30, 40), (20, 180, 60), (30, 60, 220), (255, 255, 255), (0, 0, 0)]:
        write_video(tmp_path / "clip.mp4", [np.full((64, 64, 3), colour, np.uint8)], 25)
        with open_video(tmp_path / "clip.mp4") as video:
            assert np.abs(video[0][32, 32].astype(int) - colour).max() <= 2


def test_same_frames_same_bytes(tmp_path: Path) -> None:
    """Writing twice gives the same file."""
    for name in ("a.mp4", "b.mp4"):
        write_video(tmp_path / name, (numbered(n) for n in range(30)), 25)
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()


def test_same_frames_same_bytes_in_every_process(tmp_path: Path) -> None:
    """What else a process has had in its memory does not show in the film."""
    script = (
        "import sys, numpy as np\n"
        "from app.formats import write_video\n"
        "junk = [bytes([n % 251]) * (1000 * n) for n in range(int(sys.argv[2]))]\n"
        "del junk\n"
        "random = np.random.default_rng(1)\n"
        "back = np.kron(random.integers(40, 200, (12, 20, 3)), np.ones((16, 16, 1)))\n"
        "noisy = [np.clip(np.roll(back, 2 * t, 1) + random.normal(0, 3, back.shape), 0, 255) for t in range(20)]\n"
        "write_video(sys.argv[1], [each.astype(np.uint8) for each in noisy], 25)\n"
    )
    written = []
    for junk in (10, 900):
        target = tmp_path / f"{junk}.mp4"
        subprocess.run([sys.executable, "-c", script, str(target), str(junk)], check=True)
        written.append(target.read_bytes())
    assert written[0] == written[1]


def test_working_copy_has_constant_rate(tmp_path: Path) -> None:
    """A copy of an uneven video shows at each moment what the original shows, small and at a constant rate."""
    ticks = [0, 20, 40, 60, 120, 140, 160, 240]
    write_uneven(tmp_path / "clip.mp4", ticks)
    with open_video(tmp_path / "clip.mp4") as video:
        assert not video.constant_rate
        shown = write_working_copy(video, tmp_path / "copy.mp4", long_side=128)
    assert shown.tolist() == [0, 1, 2, 3, 3, 3, 4, 5, 6, 6, 6, 6, 7]
    with open_video(tmp_path / "copy.mp4") as copy:
        assert (copy.fps, copy.size, copy.constant_rate, len(copy)) == (30, (128, 70), True, 13)


def test_fingerprint_follows_content(clips: Path, tmp_path: Path) -> None:
    """A moved copy has the same fingerprint, another file has another one."""
    (tmp_path / "moved.mp4").write_bytes((clips / "gop12.mp4").read_bytes())
    with open_video(clips / "gop12.mp4") as a, open_video(tmp_path / "moved.mp4") as b:
        assert a.fingerprint == b.fingerprint
        with open_video(clips / "gop250.mp4") as c:
            assert a.fingerprint != c.fingerprint


def test_cancelled_writing_leaves_the_old_file(tmp_path: Path) -> None:
    """A cancelled write leaves what was there, and no temporary file."""

    def stop(fraction: float) -> None:
        if fraction > 0.3:
            raise Cancelled

    (tmp_path / "clip.mp4").write_bytes(b"old")
    with pytest.raises(Cancelled):
        write_video(tmp_path / "clip.mp4", [numbered(n) for n in range(20)], 25, stop)
    assert (tmp_path / "clip.mp4").read_bytes() == b"old"
    assert len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("keep", [0.3, 0.6, 0.9])
@pytest.mark.parametrize("suffix", [".mp4", ".mkv"])
def test_truncated_videos_are_refused(clips: Path, tmp_path: Path, keep: float, suffix: str) -> None:
    """A video that was cut off is refused in one sentence; what is left can be opened on request."""
    whole = tmp_path / f"whole{suffix}"
    noise = np.random.default_rng(1).integers(0, 255, (150, 96, 176, 3), np.uint8)
    write_video(whole, [numbered(n) // 2 + noise[n] // 8 for n in range(150)], 15)
    data = whole.read_bytes()
    cut = tmp_path / f"cut{suffix}"
    cut.write_bytes(data[: int(len(data) * keep)])
    with pytest.raises(InputError, match=r"cut off|damaged"):
        open_video(cut)
    with open_video(cut, partial=True) as video:
        assert 0 < len(video) < 150


def test_mp4_without_its_index_is_refused(clips: Path, tmp_path: Path) -> None:
    """An mp4 that lost its header is not a video."""
    (tmp_path / "clip.mp4").write_bytes((clips / "gop12.mp4").read_bytes()[4000:])
    with pytest.raises(InputError, match="not a video"):
        open_video(tmp_path / "clip.mp4")


def test_files_that_are_no_videos(tmp_path: Path) -> None:
    """Missing, empty, text, sound only, a folder: each gets its own sentence."""
    (tmp_path / "text.mp4").write_text("not a video at all\n" * 99)
    (tmp_path / "empty.mp4").touch()
    with av.open(str(tmp_path / "sound.mp4"), "w") as container:
        stream = container.add_stream("aac", rate=44100, layout="mono")
        sound = av.AudioFrame.from_ndarray(np.zeros((1, 1024), np.float32), format="fltp", layout="mono")
        sound.rate = 44100
        container.mux(stream.encode(sound))
        container.mux(stream.encode(None))
    for name, words in [
        ("none.mp4", "does not exist"),
        ("empty.mp4", "is empty"),
        ("text.mp4", "not a video"),
        ("sound.mp4", "no pictures"),
        ("", "is a folder"),
    ]:
        with pytest.raises(InputError, match=words):
            open_video(tmp_path / name)


def test_video_without_frames_is_refused(tmp_path: Path) -> None:
    """A video stream of no frames is refused on reading, and none is written."""
    with av.open(str(tmp_path / "none.mkv"), "w") as container:
        stream = container.add_stream("libx264", rate=25)
        stream.width, stream.height, stream.pix_fmt = 64, 64, "yuv420p"
        container.start_encoding()
    with pytest.raises(InputError, match=r"no frames|not a video|no pictures"):
        open_video(tmp_path / "none.mkv")
    with pytest.raises(InputError, match="no frames"):
        write_video(tmp_path / "new.mp4", [], 25)
    assert not (tmp_path / "new.mp4").exists()


def test_frames_of_two_sizes_are_not_written(tmp_path: Path) -> None:
    """A frame of another size, or of floats, is named."""
    with pytest.raises(InputError, match="Frame 1 has the shape"):
        write_video(tmp_path / "clip.mp4", [numbered(0), numbered(0, 98)], 25)
    with pytest.raises(InputError, match="Frame 0 must be uint8"):
        write_video(tmp_path / "clip.mp4", [numbered(0) / 255], 25)
    assert not list(tmp_path.iterdir())


def test_folders_of_pictures_are_clips(tmp_path: Path) -> None:
    """Pictures come in natural order, at the rate given; other files do not count."""
    for number in (10, 9, 1, 2, 100):
        write_image(tmp_path / f"frame{number}.png", numbered(number))
    (tmp_path / "notes.txt").write_text("no picture")
    with open_images(tmp_path, fps=Fraction(24000, 1001)) as images:
        assert [number_of(picture) for picture in images] == [1, 2, 9, 10, 100]
        assert (images.fps, images.size) == (Fraction(24000, 1001), (176, 96))
        before = images.fingerprint
    write_image(tmp_path / "frame9.png", numbered(8))
    with open_images(tmp_path) as images:
        assert images.fingerprint != before


def test_bad_folders_of_pictures(tmp_path: Path) -> None:
    """Missing and empty folders, broken pictures and pictures of another size are named."""
    with pytest.raises(InputError, match="does not exist"):
        open_images(tmp_path / "none")
    with pytest.raises(InputError, match="holds no pictures"):
        open_images(tmp_path)
    write_image(tmp_path / "1.png", numbered(1))
    write_image(tmp_path / "2.png", numbered(1, 98))
    (tmp_path / "3.png").write_bytes(b"broken")
    with open_images(tmp_path) as images:
        with pytest.raises(InputError, match=r"2\.png is 176 x 98"):
            images[1]
        with pytest.raises(InputError, match=r"3\.png is not a picture"):
            images[2]


@settings(deadline=None, max_examples=40)
@given(data=st.data())
def test_damaged_videos_give_frames_or_one_sentence(
    tmp_path_factory: pytest.TempPathFactory, clips: Path, data: st.DataObject
) -> None:
    """Bytes changed anywhere, or the end cut off: whole pictures or an InputError, nothing else, and no hanging."""
    path = tmp_path_factory.getbasetemp() / "damaged.mp4"
    content = bytearray((clips / "gop12.mp4").read_bytes())
    for _ in range(data.draw(st.integers(1, 5))):
        start = data.draw(st.integers(0, len(content) - 1))
        content[start : start + data.draw(st.integers(1, 40))] = data.draw(st.binary(min_size=1, max_size=40))
    path.write_bytes(content[: data.draw(st.integers(len(content) // 2, len(content)))])
    try:
        with open_video(path, partial=data.draw(st.booleans())) as video:
            for frame in (0, len(video) // 2, len(video) - 1, 3 % len(video)):
                assert video[frame].shape == (video.size[1], video.size[0], 3)
    except InputError:
        return
