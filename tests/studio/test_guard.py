"""Whoever is not the page of this server is refused."""

from __future__ import annotations

import pytest

from support.scene_files import write_two_panels
from support.studio import Client, studio


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    home = tmp_path_factory.mktemp("home")
    write_two_panels(home)
    with studio(home) as (door, page):
        yield door, page


def test_the_page_is_let_in_by_the_token(served):
    door, page = served
    answer = Client(door.port).get(f"/?token={door.token}")
    assert answer.status == 303
    assert answer.headers["location"] == "/"
    cookie = answer.headers["set-cookie"].lower()
    assert "httponly" in cookie
    assert "samesite=strict" in cookie
    assert door.token not in cookie
    shown = page.get("/")
    assert shown.status == 200
    assert b"<script>" in shown.content
    policy = shown.headers["content-security-policy"]
    assert "unsafe" not in policy
    assert "http" not in policy
    assert shown.headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize(
    ("method", "path", "changes", "status"),
    [
        ("GET", "/api/state", {"Cookie": ""}, 401),
        ("GET", "/", {"Cookie": ""}, 401),
        ("GET", "/api/state", {"Cookie": "seatlook-{port}=guessed"}, 401),
        ("GET", "/api/state", {"Host": "evil.example:{port}"}, 421),
        ("GET", "/api/state", {"Host": "127.0.0.1"}, 421),
        ("GET", "/api/state", {"Origin": "http://evil.example"}, 403),
        ("GET", "/api/state", {"Origin": "http://127.0.0.1:1"}, 403),
        ("GET", "/api/state", {"Origin": "null"}, 403),
        ("GET", "/api/state", {"Sec-Fetch-Site": "cross-site"}, 403),
        ("GET", "/api/state", {"Sec-Fetch-Site": "same-site"}, 403),
        ("POST", "/api/edit", {"Origin": None}, 403),
        ("POST", "/api/edit", {"X-Seatlook": None}, 403),
        ("POST", "/api/edit", {"Origin": "http://evil.example"}, 403),
        ("GET", "/?token=guessed", {"Cookie": ""}, 401),
        ("GET", "/?token=", {}, 401),
        ("POST", "/?token={token}", {"Cookie": ""}, 401),
        ("GET", "/api/nothing", {}, 404),
        ("GET", "/api/edit", {}, 405),
    ],
)
def test_others_are_refused(served, method, path, changes, status):
    door, page = served
    words = {"port": door.port, "token": door.token}
    changed = {k: None if v is None else v.format(**words) for k, v in changes.items()}
    headers = {k: v for k, v in {**page.headers, **changed}.items() if v is not None}
    answer = Client(door.port, headers).ask(method, path.format(**words))
    assert answer.status == status
    assert b"panels" not in answer.content


def test_what_is_posted_is_limited_and_has_to_be_json(served):
    _, page = served
    assert page.post("/api/edit", b"x" * (2**20 + 1)).status == 413
    assert page.post("/api/edit", b"\xff{").status == 422
    assert page.post("/api/edit", b"[" * 100000).status == 422
    assert page.post("/api/edit", b"[]").status == 422
    assert page.post("/api/edit", {"edits": []}).status == 422
