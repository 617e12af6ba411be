"""Words that commands are made of. Everything else in a command is read by spaCy's tags alone.

The verbs are sorted by what they do with their object, because that decides which noun phrase is meant and where a
prepositional phrase belongs ("put X on Y" needs a destination, "pick up X on Y" does not).
"""

from __future__ import annotations

import re


def word_set(text: str) -> frozenset[str]:
    """The words of a text."""
    return frozenset(text.split())


# Take an object and need a place to put it.
PUT = word_set(
    """
    place put move shift drop set stack lay bring carry push pull drag slide transfer deliver position deposit
    insert throw relocate rest return lower
    """
)
# Act on an object, with no destination of their own.
TAKE = word_set(
    """
    pick take grab grasp lift raise remove hold get fetch collect retrieve open close press hit kick touch bump
    knock rotate flip release clean
    """
)
# Go somewhere; the goal follows a preposition.
GO = word_set(
    """
    go drive move head walk run come travel roll navigate proceed advance continue return ride approach race
    rush steer stop park stand wait stay keep remain halt back drop get sit pull make cross bring take
    """
)
# Have the goal as their direct object.
REACH = word_set(
    """
    approach find reach locate visit see seek meet follow target hit touch face check inspect examine identify
    choose select click tap mark highlight indicate avoid dodge evade leave pass circle look search want need show
    spot watch point enter explore
    """
)
LOOK = word_set("turn look face rotate spin point watch see swivel pivot orient align notice")
SHUN = frozenset(["avoid", "dodge", "evade", "leave", "pass", "circle"])
COMMANDS = PUT | TAKE | GO | REACH | LOOK
COPULAS = word_set("be is are 's 're was were being am 'm lie lies re")
# Tagged as nouns often; a verb of these stands at the start of a clause.
NEGATIONS = frozenset({"neither", "nor", "not", "n't", "never", "nt", "dont", "don't"})

# Words of noun phrases that are never part of the noun.
ORDINALS = word_set(
    """
    first second third fourth fifth sixth seventh eighth ninth tenth last 1st 2nd 3rd 4th 5th next
    """
)
SIDES = word_set("left right front back top bottom middle center rear upper lower far near")
ADJECTIVES = word_set(
    """
    big bigger biggest large larger largest small smaller smallest little tiny huge tall taller tallest short
    shorter shortest high higher highest low lower lowest wide narrow long longest thin thick round square
    rectangular flat closest nearest farthest furthest closer nearer further leftmost rightmost topmost
    bottommost frontmost uppermost lowermost rearmost backmost foremost other another same single double only
    lone alone different metal wooden plastic rubber cardboard glass steel upside old new nearby exposed
    opposite whole entire top remaining identical central outer inner extreme very visible hidden empty full
    medium average giant massive middlemost centermost
    cubic conical cylindrical spherical solid striped shiny light dark
    """
)
SIZES = word_set("big large small little tiny huge tall short wide narrow long thin thick medium mid average normal")
# "large-ish", "largish" and "large-sized" mean large.
SIZED = {f"{size}{ending}": size for size in SIZES for ending in ("ish", "-sized")} | {
    "largish": "large", "biggish": "big", "widish": "wide",
}  # fmt: skip
MODIFIERS = ORDINALS | SIDES | ADJECTIVES | SIZED.keys()
QUANTIFIERS = frozenset(["all", "either", "every", "each", "both", "any", "some", "several"])
NUMBERS = {"one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8, "nine": 9, "ten": 10}
GROUPS = word_set(
    """
    row line column stack pile group bunch set pair couple tower cluster collection array heap circle ring series
    trio formation arrangement
    """
)
# "go to the position of the cone" means the cone.
CARRIERS = frozenset(["location", "position", "place", "spot", "vicinity", "site", "kind", "type"])
MEASURES = word_set(
    """
    square space step meter metre foot inch centimeter centimetre unit cell tile degree cm m ft second minute
    time
    """
)
DIRECTIONS = word_set(
    """
    left right front back forward way direction distance end rear top bottom ahead side
    """
)
ROBOT = frozenset(["robot", "turtlebot", "bot", "yourself", "you", "machine", "rover"])
HOLDERS = ROBOT | {"arm", "hand", "gripper", "claw"}
PRONOUNS = {
    "me": "me", "myself": "me", "i": "me", "mine": "me", "us": "me", "you": "you", "yourself": "you",
    "yours": "you", "it": None, "itself": None, "them": None, "they": None, "this": None, "that": None, "these": None,
    "those": None, "one": None, "ones": None, "he": None, "him": None, "she": None, "her": None,
}  # fmt: skip
NORMAL_WORDS = {
    "nearest": "closest", "nearer": "closer", "furthest": "farthest", "further": "farther", "centre": "center",
    "1st": "first", "2nd": "second", "3rd": "third", "4th": "fourth", "5th": "fifth", "holding": "held",
    "uppermost": "topmost", "rear": "back", "backmost": "rearmost", "centermost": "middlemost",
    "forwards": "forward", "backwards": "backward", **SIZED,
}  # fmt: skip
ADVERBS = word_set(
    """
    then now slowly quickly directly straight just forward forwards backward backwards there here please
    carefully immediately right exactly almost again ahead together away first finally next afterwards also too
    back over up down out off around along so still diagonally diametrically clockwise
    """
)

OPENINGS = word_set("ok okay alright hey hi hello yes yeah yep no nope so")  # said before the command begins
FILLERS = word_set("um uh uhm umm uhh er erm hm hmm hmmm ah oh eh")
WAYS = word_set("left right forward forwards backward backwards front back away up down sideways")
ALONE_RE = re.compile(r"(?:all )?(?:alone|by (?:itself|themselves)|on its own)(?= |$)")
# "facing left" is how a thing stands, and a word of its noun phrase; "facing the wall" has a landmark.
FACING_RE = re.compile(
    r"(?P<verb>facing|faces|face|pointing|pointed|points|looking|looks|turned|oriented|angled)"
    rf"(?: to(?:wards?)?)?(?: the| my| your)? (?P<way>{'|'.join(sorted(WAYS, key=len, reverse=True))})"
    r"(?= (?!of |side )|$)"
)

_VIEW = r"(?:perspective|point of view|viewpoint|view|angle)"
_NO_VIEW = rf"(?! (?:my|your) {_VIEW})"
VIEW_RE = re.compile(rf"(?:from|in) (?P<owner>my|your) {_VIEW}(?= |$)")

# Prepositions, read on the words of the command; the first pattern that fits wins. The normal form follows.
_THE = r"(?:the |your |its |my |a )?"
_AT = r"(?:to|on|at|in|from|towards?)"
_SIDE = r"(?: hand)?(?: side)?"
PREPOSITIONS: tuple[tuple[str, str], ...] = (
    (r"from (?:on )?(?:the )?top of|from (?:on top|atop)(?: of)?", "on top of"),
    (r"from (?=(?:above|behind|under|underneath|below|beside|near|between|next|in front|over|inside) )", ""),
    (r"(?:to |on |onto |on to |at |in |over )?(?:the )?top (?:side |part )?of", "on top of"),
    (r"(?:up )?on top(?= the )|atop(?: of)?|ontop(?: of)?", "on top of"),
    (rf"{_AT} {_THE}(?:immediate |direct |far |very )?left{_SIDE} (?:of|to|from)(?! where){_NO_VIEW}", "left of"),
    (rf"{_AT} {_THE}(?:immediate |direct |far |very )?right{_SIDE} (?:of|to|from)(?! where){_NO_VIEW}", "right of"),
    (r"left(?: hand)?(?: side)? of|left to(?= )", "left of"),
    (r"right(?: hand)?(?: side)? of|right to(?= (?:the |a )?\w+ ?(?:\w+ )?)", "right of"),
    (rf"(?:in|at|to|on|into) {_THE}front(?: side)? of|infront(?: of)?|front of", "in front of"),
    (rf"(?:in|at|to|on) {_THE}(?:back|rear)(?: side)? of|in back of|back of", "behind"),
    (rf"(?:in|at|to|on) {_THE}bottom of(?= (?:the |a )?(?:{'|'.join(sorted(GROUPS))})(?: |$))", "at the bottom of"),
    (rf"(?:in|at|to|on) {_THE}bottom of|underneath|beneath|under(?:neath)?|below", "under"),
    (rf"(?:in|at|to|into) {_THE}(?:middle|cent(?:er|re)) (?:of|between)", "in the middle of"),
    (r"all the way(?= )|(?:way|right|just|directly|immediately) (?=(?:over|on|at|in|to|behind|next|under|above) )", ""),
    (r"(?:facing|pointing) (?:to|at|towards?)|(?:facing|pointing)(?= away from )", "facing"),
    (r"(?:of |with )?the same colou?r as", "same color as"),
    (r"(?:of |with )?the same size as", "same size as"),
    (r"(?:of |with )?the same (?:shape|kind|type) as", "same shape as"),
    (r"in between|inbetween|between", "between"),
    (r"in the midst of|among(?:st)?", "among"),
    (r"(?:the )?(?:closest|nearest|near most) (?:to|from|by)", "closest to"),
    (r"closest|nearest", "closest to"),
    (r"(?:the )?(?:farthest|furthest|most distant) (?:away )?(?:from|to)", "farthest from"),
    (r"(?:closer|nearer) to|nearer", "closer to"),
    (r"(?:farther|further) (?:away )?from", "farther from"),
    (r"far(?: away)? from", "far from"),
    (r"(?:as )?(?:close|near) as (?:you can|possible)(?: get)?(?: to)?", "close to"),
    (r"(?:up )?(?:very )?close (?:up )?(?:to|by)|(?:up )?close(?= the )", "close to"),
    (r"away from|clear of|off of|off(?= (?:the|of) )", "away from"),
    (r"adjacent to|next to|(?:to|on|at|by|along) (?:the )?side of", "next to"),
    (r"along ?side(?: of)?|besides?|next(?= the )", "next to"),
    (r"near to|nearby to|nearby(?= the )|near(?: by)?|in the (?:vicinity|proximity|neighbou?rhood) of", "near"),
    (r"(?:in|into) the direction of|in direction of|towards?|in the direction to", "towards"),
    (r"(?:over|up|across|back|on|out|down) to(?= the)|up (?:un)?to|(?:over|back|down|across) to|unto", "to"),
    (r"to where|until|till", "to"),
    (r"ahead of", "ahead of"),
    (r"diagonal(?:ly)? (?:to|from|across from)", "diagonal to"),
    (r"across from|opposite(?: to| of| from)?(?= (?:the|you|me|your) )", "opposite"),
    (r"on ?to", "onto"),
    (r"in ?to", "into"),
    (r"inside(?: of)?|within", "in"),
    (r"outside(?: of)?", "outside"),
    (r"instead of|rather than|except(?: for)?|apart from", "instead of"),
    (r"by means of|by way of|via", "via"),
    (r"because of|according to|due to", "because of"),
    (r"from|to|on|at|in|by|behind|above|over|past|around|round|through|thru|across|along|against|with|without|beyond"
     r"|before|after|for|of|opposite|touching|facing|about|like|than|upon|as", "="),
)  # fmt: skip
PREPOSITION_RE = re.compile("|".join(f"(?P<p{i}>(?:{pattern})(?= |$))" for i, (pattern, _) in enumerate(PREPOSITIONS)))
SAME = {"round": "around", "thru": "through", "upon": "on"}

# A motion may end there.
GOALS = word_set("to towards onto into near behind on at by under above between in opposite against over for") | {
    "before", "close to", "closer to", "closest to", "next to", "in front of", "left of", "right of", "on top of",
    "in the middle of", "away from", "far from", "ahead of", "farther from",
}  # fmt: skip
STRONG = frozenset({"to", "onto", "into", "towards"})
PATHS = frozenset({"past", "around", "through", "via", "along", "across", "from", "without", "with", "of", "about",
                   "instead of", "after", "because of", "like", "than", "as"})  # fmt: skip
SUPPORTS = frozenset({"on", "on top of", "onto", "above", "over", "into", "in"})
EXTREMES = frozenset({"closest to", "farthest from", "closer to", "farther from"})
PLACES = word_set(
    """
    corner edge center middle left right side end border margin back front top bottom floor ground board wall
    room row grid table hand gripper
    """
)  # fmt: skip
