"""A campaign folder: `campaign.toml` and its place among the others. Only reads."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from pydantic import BaseModel, ConfigDict, ValidationError

from deamat.core.errors import RawFileError
from deamat.core.slug import nearest_slug, slug_fault
from deamat.core.toml import parse_toml

CAMPAIGN_FILE = "campaign.toml"
MANIFEST_FILE = "MANIFEST.sha256"


class CampaignInfo(BaseModel):
    """What `campaign.toml` must and may say; further keys are the laboratory's own notes.

    Parameters
    ----------
    synthetic : true marks every card, figure and page made from the campaign
    timezone : of stamps without an offset
    ends_open : the exporters of this campaign write no final line end
    """

    model_config = ConfigDict(extra="allow", frozen=True)

    title: str
    laboratory: str
    licence: str
    synthetic: bool
    source: str = ""
    note: str = ""
    timezone: str = "UTC"
    ends_open: bool = False


@dataclass(frozen=True, slots=True)
class Campaign:
    """One folder under `raw/` that has a `campaign.toml`."""

    name: str
    folder: Path
    info: CampaignInfo

    def __str__(self) -> str:
        return self.name


def is_campaign_file(path: str) -> bool:
    """Say whether a path relative to `raw/` is that of a campaign's `campaign.toml`."""
    return path.count("/") == 1 and path.endswith(f"/{CAMPAIGN_FILE}")


def load_campaign(folder: Path, data: bytes) -> Campaign:
    """Read `campaign.toml`.

    Parameters
    ----------
    folder : of the campaign
    data : content of its `campaign.toml`

    Raises
    ------
    RawFileError : it does not parse, or lacks a title, laboratory, licence or `synthetic`, or the
        folder's name is no id
    """
    path = f"{folder.name}/{CAMPAIGN_FILE}"
    if fault := slug_fault(folder.name):
        near = nearest_slug(folder.name)
        hint = f"the folder names the campaign: rename it, nearest valid: {near!r}"
        raise RawFileError(path, fault, None, None, folder.name, hint)
    try:
        declared = parse_toml(data)
    except ValueError as error:
        raise RawFileError(path, f"not valid TOML: {error}") from error
    try:
        info = CampaignInfo.model_validate(declared)
    except ValidationError as error:
        said = "; ".join(f"{'.'.join(map(str, e['loc']))}: {e['msg']}" for e in error.errors())
        raise RawFileError(
            path,
            said,
            hint="a campaign declares title, laboratory and licence as text, and whether its data "
            "are simulated: `synthetic = false` for measurements",
        ) from error
    return Campaign(folder.name, folder, info)
