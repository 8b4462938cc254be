"""usage: orb_vocabulary.py OUT.txt PICTURE...: a small bag of words of ORB descriptors in DBoW2's text format, from the pictures of
the documents. ORB-SLAM3's own file of 139 MB is not on PyPI. A tree of three levels has all features in one node of the level at
which ORB-SLAM3 compares frames, so it compares all of them; loops and relocalisation are weaker than with the large file."""
import sys

import cv2
import numpy as np

BRANCHES, LEVELS = 10, 3
PASSES = 6       # of k-medians
FEATURES = 800   # of a picture


def read_descriptors(paths):
    orb, found = cv2.ORB_create(FEATURES), []
    for path in sorted(paths):
        picture = cv2.imread(path, cv2.IMREAD_GRAYSCALE)
        if picture is None:
            raise SystemExit("%s: no picture" % path)
        descriptors = orb.detectAndCompute(picture, None)[1]
        if descriptors is not None:
            found.append(descriptors)
    return np.unpackbits(np.vstack(found), axis=1).astype(np.float32)


def distances(bits, centres):
    """Hamming, of every row of one to every row of the other."""
    return bits.sum(1)[:, None] + centres.sum(1)[None, :] - 2 * bits @ centres.T


def split(bits, members, parent, level, nodes, random):
    """Appends the children of a node, and theirs: (parent, whether it is a word, descriptor). Nodes are numbered from 1."""
    own, count = bits[members], min(BRANCHES, len(members))
    centres = own[random.choice(len(members), count, replace=False)]
    for _ in range(PASSES):
        nearest = distances(own, centres).argmin(1)
        centres = np.stack([(own[nearest == j].mean(0) > 0.5).astype(np.float32) if (nearest == j).any() else centres[j]
                            for j in range(count)])
    for j in range(count):
        word = level == LEVELS or (nearest == j).sum() <= BRANCHES
        nodes.append((parent, word, np.packbits(centres[j].astype(np.uint8))))
        if not word:
            split(bits, members[nearest == j], len(nodes), level + 1, nodes, random)


def main():
    out, bits, nodes = sys.argv[1], read_descriptors(sys.argv[2:]), []
    split(bits, np.arange(len(bits)), 0, 1, nodes, np.random.default_rng(1))
    with open(out, "w") as file:
        file.write("%d %d 0 0\n" % (BRANCHES, LEVELS))  # weights: TF-IDF, score: L1
        for parent, word, descriptor in nodes:
            file.write("%d %d %s %s\n" % (parent, word, " ".join(map(str, descriptor)), "1.0" if word else "0"))
    print(len(bits), "descriptors,", len(nodes), "nodes")


if __name__ == "__main__":
    main()
